#pragma once

/// @file Aligned, growable columns of numbers: the building block of every structure of arrays here.

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

namespace mpmfast {

/// A contiguous 64-byte aligned array whose tail is padded, so that vector loops may read past the end.
template <class T>
class Column {
 public:
  static constexpr std::size_t kPadding = 64;  ///< elements readable beyond size()

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }
  std::size_t size() const { return size_; }
  /// That the system has given: not those of the pages where no element was in yet.
  std::size_t bytes() const {
    const std::size_t all = capacity_ * sizeof(T), page = all < kHuge ? kPage : kHugePage;
    return std::min(all, (zeroed_ * sizeof(T) + page - 1) / page * page);
  }

  /// Grows if needed (contents are then lost and zeroed); never shrinks the memory.
  /// @param capacity  elements that it grows to, if it must
  void resize_discard(std::size_t n, std::size_t capacity = 0) {
    if (n + kPadding > capacity_) {
      const std::size_t needed = (std::max(n, capacity) + kPadding) * sizeof(T);
      const std::size_t grain = needed < kHuge ? 64 : kHugePage;
      const std::size_t bytes = (needed + grain - 1) / grain * grain;
      T* raw = static_cast<T*>(std::aligned_alloc(grain, bytes));
      if (!raw) throw std::bad_alloc();
      if (grain == kHugePage) madvise(raw, bytes, MADV_HUGEPAGE);  // a wish: refused, it is only slower
      data_.reset(raw);
      capacity_ = bytes / sizeof(T);
      zeroed_ = 0;
    }
    if (n + kPadding > zeroed_) {
      std::memset(static_cast<void*>(data() + zeroed_), 0, (n + kPadding - zeroed_) * sizeof(T));
      zeroed_ = n + kPadding;
    }
    size_ = n;
  }

  /// At least n elements: those that were there keep their values, what the others hold is not said. Where it
  /// must take new memory, it takes a quarter more, since what grows once grows again.
  void grow(std::size_t n) {
    if (n + kPadding <= capacity_) return resize_discard(n);
    Column larger;
    larger.resize_discard(n, n + n / 4);
    if (size_ > 0) std::memcpy(static_cast<void*>(larger.data()), data(), size_ * sizeof(T));
    *this = std::move(larger);
  }

 private:
  /// Large columns ask for large pages: a pass goes along a dozen columns at once, each in pages of its own,
  /// more than the processor knows by heart.
  static constexpr std::size_t kHugePage = std::size_t{1} << 21, kHuge = 2 * kHugePage, kPage = 4096;

  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
  std::size_t zeroed_ = 0;  ///< elements that were zeroed when they first came into use
};

}  // namespace mpmfast
