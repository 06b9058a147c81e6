/* Preloaded by nothing_lost.sh: every write of the program takes SLOW_WRITE_US microseconds and at most
   SLOW_WRITE_BYTES bytes, as on a disk far away; a call in five is interrupted before it wrote anything. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static long setting(const char* name, long otherwise) {
  const char* text = getenv(name);
  return text ? atol(text) : otherwise;
}

static size_t wait_and_cut(int file, size_t bytes) {
  if (file <= 2) return bytes;
  usleep((useconds_t)setting("SLOW_WRITE_US", 1000));
  const size_t most = (size_t)setting("SLOW_WRITE_BYTES", 1000);
  return bytes < most ? bytes : most;
}

static int interrupted(int file) {
  static unsigned calls = 0;
  if (file <= 2 || __atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED) % 5) return 0;
  errno = EINTR;
  return 1;
}

ssize_t write(int file, const void* data, size_t bytes) {
  ssize_t (*next)(int, const void*, size_t) = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  return interrupted(file) ? -1 : next(file, data, wait_and_cut(file, bytes));
}

ssize_t writev(int file, const struct iovec* pieces, int count) {
  return count > 0 ? write(file, pieces[0].iov_base, pieces[0].iov_len) : 0;
}

ssize_t pwrite(int file, const void* data, size_t bytes, off_t at) {
  ssize_t (*next)(int, const void*, size_t, off_t) =
      (ssize_t(*)(int, const void*, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  return interrupted(file) ? -1 : next(file, data, wait_and_cut(file, bytes), at);
}

ssize_t pwrite64(int file, const void* data, size_t bytes, off_t at) { return pwrite(file, data, bytes, at); }
