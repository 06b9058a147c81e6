#include "quiet_threads.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace mpmfast {

void wait_quietly(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error || setenv("GOMP_SPINCOUNT", "1000", 0) != 0) return;
  execv(self.c_str(), arguments);
}

}  // namespace mpmfast
