// How much memory a process may take: limits of control groups as files tell them, and of the process itself.

#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "engine/plan/memory_limits.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

namespace fs = std::filesystem;

/// A file system with the files that say where control groups are, and their limits.
class Root {
 public:
  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  std::uint64_t limit() { return control_group_memory(folder_ / ""); }

 private:
  test::Folder folder_;
};

constexpr const char* kSecond = "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw\n";

TEST_CASE("the least limit of the groups around a process counts, of version 2") {
  Root root;
  CHECK(root.limit() == 0);
  root.write("proc/self/mountinfo", kSecond);
  root.write("proc/self/cgroup", "0::/user.slice/job 7\n");
  CHECK(root.limit() == 0);
  root.write("sys/fs/cgroup/user.slice/memory.max", "5000\n");
  root.write("sys/fs/cgroup/user.slice/job 7/memory.max", "max\n");
  CHECK(root.limit() == 5000);
  root.write("sys/fs/cgroup/user.slice/job 7/memory.max", "4000\n");
  CHECK(root.limit() == 4000);
  root.write("sys/fs/cgroup/memory.max", "3000\n");
  CHECK(root.limit() == 3000);
}

TEST_CASE("the memory hierarchy of version 1 counts, beside others and where it is mounted") {
  Root root;
  root.write("proc/self/mountinfo",
             "33 32 0:30 / /cg/cpu rw - cgroup cgroup rw,cpu,cpuacct\n"
             "34 32 0:31 / /cg/two\\040words rw shared:9 - cgroup cgroup rw,memory\n");
  root.write("proc/self/cgroup", "12:cpu,cpuacct:/other\n4:memory:/batch/job\n0::/unified\n");
  root.write("cg/cpu/other/memory.limit_in_bytes", "1\n");
  root.write("cg/two words/memory.limit_in_bytes", "9223372036854771712\n");
  root.write("cg/two words/batch/memory.limit_in_bytes", "7000\n");
  root.write("cg/two words/batch/job/memory.limit_in_bytes", "8000\n");
  CHECK(root.limit() == 7000);
}

TEST_CASE("in a container the group at the mount point is that of the process") {
  Root root;
  root.write("proc/self/mountinfo",
             "30 23 0:26 /docker/abc /sys/fs/cgroup ro - cgroup2 cgroup rw\n31 23 0:27 broken\nnonsense\n");
  root.write("sys/fs/cgroup/memory.max", "6000\n");
  root.write("sys/fs/cgroup/inner/memory.max", "2000\n");
  for (const char* group : {"0::/docker/abc\n", "0::/elsewhere\n", "0::/../../other\n", "0::/\n"}) {
    root.write("proc/self/cgroup", group);
    CHECK_MESSAGE(root.limit() == 6000, group);
  }
  root.write("proc/self/cgroup", "0::/docker/abc/inner\n");
  CHECK(root.limit() == 2000);
}

/// Under a limit of a child process of ours.
bool tells_limit(__rlimit_resource_t which, std::uint64_t bytes) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit now{bytes, bytes};
    setrlimit(which, &now);
    const MemoryLimit limit = available_memory();
    _exit(limit.bytes > 0 && limit.bytes < bytes &&
                  std::string(limit.whose).find("ulimit") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// The address sanitizer takes more address space than these limits leave.
TEST_CASE("limits on address space and data count, less what is taken" * doctest::skip(test::sanitized())) {
  CHECK(available_memory().bytes > 0);
  CHECK(tells_limit(RLIMIT_AS, std::uint64_t{1} << 30));
  CHECK(tells_limit(RLIMIT_DATA, std::uint64_t{1} << 29));
}

}  // namespace
}  // namespace mpmfast
