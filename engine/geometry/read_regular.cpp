#include "engine/geometry/read_regular.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace mpmfast {
namespace {

/// Closes itself.
struct OpenFile {
  explicit OpenFile(int number) : fd(number) {}
  ~OpenFile() {
    if (fd >= 0) ::close(fd);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd;
};

std::string size_text(std::uintmax_t bytes) {
  constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;
  return bytes >= kMebibyte ? fmt::format("{} MiB", bytes / kMebibyte) : fmt::format("{} bytes", bytes);
}

/// Why a file of this kind is not read; empty where it is.
std::string refusal(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return "it is a folder";
  return S_ISREG(status.st_mode) ? "" : "it is not a file but a device, a pipe or a socket";
}

}  // namespace

std::optional<std::string> read_regular(const std::filesystem::path& file, std::uintmax_t most,
                                        std::string& why_not) {
  const auto refuse = [&](std::string why) {
    why_not = std::move(why);
    return std::nullopt;
  };
  const auto refuse_by_system = [&] {
    return refuse(errno == ENOENT ? "no such file" : std::strerror(errno));
  };
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return refuse_by_system();
  if (std::string why = refusal(status); !why.empty()) return refuse(std::move(why));
  // What takes its place between the two calls must not hold us up either.
  const OpenFile open(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (open.fd < 0 || ::fstat(open.fd, &status) != 0) return refuse_by_system();
  if (std::string why = refusal(status); !why.empty()) return refuse(std::move(why));
  const auto refuse_size = [&] { return refuse("it is larger than " + size_text(most)); };
  if (static_cast<std::uintmax_t>(status.st_size) > most) return refuse_size();
  constexpr std::size_t kBlock = std::size_t{1} << 16;                   // bytes; files of /proc tell no size
  std::string text(static_cast<std::size_t>(status.st_size) + 1, '\0');  // one more tells the end
  for (std::size_t there = 0;;) {
    if (there == text.size()) text.resize(2 * there + kBlock);
    const ssize_t now = ::read(open.fd, text.data() + there, text.size() - there);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) return refuse_by_system();
    there += static_cast<std::size_t>(now);
    if (there > most) return refuse_size();
    if (now > 0) continue;
    text.resize(there);
    return text;
  }
}

}  // namespace mpmfast
