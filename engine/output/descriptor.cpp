#include "engine/output/descriptor.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"

namespace mpmfast {
namespace {

constexpr mode_t kUsual = 0666;  // less what the user's mask takes away

}  // namespace

Descriptor Descriptor::open(const std::filesystem::path& path, bool writing) {
  // A pipe would hold us up until somebody writes to it.
  Descriptor file(::open(path.c_str(), (writing ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK));
  if (file.fd_ < 0) throw_file_error(writing ? "write" : "read", path);
  struct stat status {};
  if (::fstat(file.fd_, &status) == 0 && !S_ISREG(status.st_mode))
    throw FileError(path.string() + " is not a file but a folder, a device, a pipe or a socket");
  return file;
}

Descriptor Descriptor::open_folder(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) throw_file_error("read", path);
  return Descriptor(fd);
}

Descriptor Descriptor::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, kUsual);
  if (fd < 0) throw_file_error("write", path);
  return Descriptor(fd);
}

Descriptor Descriptor::open_or_create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kUsual);
  if (fd < 0) throw_file_error("write", path);
  return Descriptor(fd);
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

std::size_t Descriptor::read_at(char* out, std::size_t n, std::uint64_t offset,
                                const std::filesystem::path& path) const {
  std::size_t done = 0;
  while (done < n) {
    const ssize_t now = ::pread(fd_, out + done, n - done, static_cast<off_t>(offset + done));
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw_file_error("read", path);
    if (now == 0) break;
    done += static_cast<std::size_t>(now);
  }
  return done;
}

void Descriptor::write_at(std::string_view content, std::uint64_t offset,
                          const std::filesystem::path& path) const {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t now =
        ::pwrite(fd_, content.data() + done, content.size() - done, static_cast<off_t>(offset + done));
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw_file_error("write", path);
    done += static_cast<std::size_t>(now);
  }
}

void Descriptor::cut(std::uint64_t size, const std::filesystem::path& path) const {
  if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) throw_file_error("cut", path);
}

void Descriptor::sync(const std::filesystem::path& path) const {
  if (::fsync(fd_) != 0) throw_file_error("write", path);
}

bool Descriptor::claim() const { return ::flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

bool Descriptor::has_name() const {
  struct stat status {};
  return ::fstat(fd_, &status) != 0 || status.st_nlink > 0;
}

bool Descriptor::is_at(const std::filesystem::path& path) const {
  struct stat own {
  }, named{};
  return ::fstat(fd_, &own) == 0 && ::stat(path.c_str(), &named) == 0 && own.st_dev == named.st_dev &&
         own.st_ino == named.st_ino;
}

void sync_folder(const std::filesystem::path& folder) noexcept {
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace mpmfast
