#pragma once

/// @file Aligned, growable columns of numbers: the building block of every structure of arrays here.

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

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
  std::size_t bytes() const { return capacity_ * sizeof(T); }

  /// Grows if needed (contents are then lost and zeroed); never shrinks the memory.
  void resize_discard(std::size_t n) {
    if (n + kPadding > capacity_) {
      const std::size_t bytes = ((n + kPadding) * sizeof(T) + 63) / 64 * 64;
      T* raw = static_cast<T*>(std::aligned_alloc(64, bytes));
      if (!raw) throw std::bad_alloc();
      std::memset(static_cast<void*>(raw), 0, bytes);
      data_.reset(raw);
      capacity_ = bytes / sizeof(T);
    }
    size_ = n;
  }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace mpmfast
