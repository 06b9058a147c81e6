#pragma once

/// @file How much memory this process may take: what the machine has, less where a limit says so.

#include <cstdint>
#include <filesystem>

namespace mpmfast {

/// A bound, and whose it is, for a message.
struct MemoryLimit {
  std::uint64_t bytes = 0;  ///< 0: none is known
  const char* whose = "";   ///< "of the machine", "by the control group's limit", …
};

/// The least of what the machine has, of the limits of the control groups that this process is in (versions 1
/// and 2), and of its own limits on address space and data (ulimit -v, -d), less what it has taken already.
MemoryLimit available_memory();

/// The least limit of the control groups of this process and of those around them, bytes; 0 where there is
/// none.
/// @param root  of the file system, for tests: ROOT/proc/self/cgroup and mountinfo say where they are
std::uint64_t control_group_memory(const std::filesystem::path& root = "/");

}  // namespace mpmfast
