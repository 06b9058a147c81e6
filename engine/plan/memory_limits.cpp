#include "engine/plan/memory_limits.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace mpmfast {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNone = ~std::uint64_t{0};

/// Where a hierarchy of control groups is mounted, and which of them is there.
struct GroupMount {
  std::string shown;  ///< the group at the mount point
  fs::path at;
  bool second;  ///< of version 2
};

std::vector<std::string> words_of(const std::string& line, char between) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, between);) words.push_back(word);
  return words;
}

bool has_word(const std::string& list, std::string_view word) {
  const std::vector<std::string> words = words_of(list, ',');
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The kernel writes a blank in a path as \040.
std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    int code = 0;
    const bool escape =
        text[k] == '\\' && k + 3 < text.size() &&
        std::from_chars(text.data() + k + 1, text.data() + k + 4, code, 8).ptr == text.data() + k + 4;
    out += escape ? static_cast<char>(code) : text[k];
    if (escape) k += 3;
  }
  return out;
}

/// "36 25 0:31 GROUP PLACE rw,… shared:9 - cgroup2 cgroup rw,…": nothing where it is no hierarchy of memory.
std::optional<GroupMount> read_mount(const std::string& line) {
  const std::size_t dash = line.find(" - ");
  if (dash == std::string::npos) return std::nullopt;
  const auto before = words_of(line.substr(0, dash), ' '), after = words_of(line.substr(dash + 3), ' ');
  if (before.size() < 5 || after.size() < 3) return std::nullopt;
  const bool second = after[0] == "cgroup2", first = after[0] == "cgroup" && has_word(after[2], "memory");
  if (!first && !second) return std::nullopt;
  return GroupMount{unescaped(before[3]), unescaped(before[4]), second};
}

/// "0::/user.slice" or "5:memory,cpu:/user.slice": the group of this process.
std::optional<std::string> read_group(const std::string& line, bool second) {
  const std::size_t first_colon = line.find(':'), colon = line.find(':', first_colon + 1);
  if (first_colon == std::string::npos || colon == std::string::npos) return std::nullopt;
  const std::string kinds = line.substr(first_colon + 1, colon - first_colon - 1);
  if (second ? !kinds.empty() : !has_word(kinds, "memory")) return std::nullopt;
  return line.substr(colon + 1);
}

/// The number in a file; kNone where there is none ("max").
std::uint64_t number_in(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t value = kNone;
  return stream >> value ? value : kNone;
}

/// The least limit from a group up to that at the mount point. A group that this process does not see there
/// (a container's) has its own at the mount point.
std::uint64_t least_limit(const GroupMount& mount, const fs::path& root, const std::string& group) {
  const char* file = mount.second ? "memory.max" : "memory.limit_in_bytes";
  const fs::path top = root / mount.at.relative_path();
  const std::string shown = mount.shown == "/" ? "" : mount.shown;
  fs::path below;
  if (group.compare(0, shown.size(), shown) == 0 && group.find("..") == std::string::npos)
    below = fs::path(group.substr(shown.size())).relative_path();
  std::uint64_t least = number_in(top / file);
  fs::path at = top;
  for (const fs::path& part : below) {
    at /= part;
    least = std::min(least, number_in(at / file));
  }
  return least;
}

std::uint64_t machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : kNone;
}

/// What a limit of the process leaves. @param taken  pages: which number of /proc/self/statm
std::uint64_t left_of(int limit, std::size_t taken) {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource_t>(limit), &now) != 0 || now.rlim_cur == RLIM_INFINITY)
    return kNone;
  std::ifstream stream("/proc/self/statm");
  std::uint64_t pages = 0;
  for (std::size_t k = 0; k <= taken && stream >> pages; ++k) {
  }
  const std::uint64_t used = pages * static_cast<std::uint64_t>(std::max(sysconf(_SC_PAGE_SIZE), 1L));
  return now.rlim_cur > used ? now.rlim_cur - used : 1;
}

}  // namespace

std::uint64_t control_group_memory(const fs::path& root) {
  const fs::path self = root / "proc/self";
  std::ifstream mounts(self / "mountinfo");
  std::uint64_t least = kNone;
  for (std::string line; std::getline(mounts, line);) {
    const auto mount = read_mount(line);
    if (!mount) continue;
    std::ifstream groups(self / "cgroup");
    for (std::string one; std::getline(groups, one);)
      if (const auto group = read_group(one, mount->second))
        least = std::min(least, least_limit(*mount, root, *group));
  }
  return least == kNone ? 0 : least;
}

MemoryLimit available_memory() {
  constexpr std::size_t kSize = 0, kData = 5;  // of /proc/self/statm
  const std::uint64_t groups = control_group_memory();
  MemoryLimit least{machine_memory(), "of the machine"};
  const auto take = [&](std::uint64_t bytes, const char* whose) {
    if (bytes < least.bytes) least = {bytes, whose};
  };
  if (groups > 0) take(groups, "by the control group's limit");
  take(left_of(RLIMIT_AS, kSize), "left by the limit on address space, ulimit -v");
  take(left_of(RLIMIT_DATA, kData), "left by the limit on data, ulimit -d");
  if (least.bytes == kNone) least.bytes = 0;
  return least;
}

}  // namespace mpmfast
