#include "engine/output/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"

namespace mpmfast {
namespace {

/// The library speaks through our messages alone, and leaves nothing to do at the end of the program: after a
/// full disk it would try for ever.
void quieten() {
  static const bool once = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  static_cast<void>(once);
}

hid_t type_of(NumberKind kind) {
  switch (kind) {
    case NumberKind::real:
      return H5T_NATIVE_DOUBLE;
    case NumberKind::whole64:
      return H5T_NATIVE_UINT64;
    case NumberKind::whole32:
      return H5T_NATIVE_UINT32;
    case NumberKind::whole16:
      return H5T_NATIVE_UINT16;
    case NumberKind::whole8:
      return H5T_NATIVE_UINT8;
    case NumberKind::signed32:
      return H5T_NATIVE_INT32;
  }
  return H5I_INVALID_HID;
}

/// The system's error number where the library met one: it says so in the text of its lowest complaint.
herr_t find_error_number(unsigned, const H5E_error2_t* complaint, void* out) {
  if (!complaint->desc) return 0;
  const std::string_view text = complaint->desc, mark = "errno = ";
  const std::size_t at = text.find(mark);
  if (at != std::string_view::npos)
    std::from_chars(text.data() + at + mark.size(), text.data() + text.size(), *static_cast<int*>(out));
  return 0;
}

[[noreturn]] void fail(std::string_view action, const std::filesystem::path& path) {
  int error = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_error_number, &error);
  throw_file_error(action, path, error);
}

Hdf5Handle properties(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

/// Bytes of a dataset that lies in one piece in the file itself, as ours do; of any other none. A dataset may
/// claim any number of entries and hold none, which would take the memory of all.
std::size_t bytes_in_file(hid_t data) {
  const Hdf5Handle creation(H5Dget_create_plist(data), H5Pclose);
  if (!creation.valid() || H5Pget_layout(creation.id()) != H5D_CONTIGUOUS ||
      H5Pget_external_count(creation.id()) != 0)
    return 0;
  return static_cast<std::size_t>(H5Dget_storage_size(data));
}

/// Without locks of the library's own, which not every file system can give.
Hdf5Handle access() {
  Hdf5Handle list = properties(H5P_FILE_ACCESS);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(list.id(), false, true);
#endif
  return list;
}

}  // namespace

Hdf5File::Lock Hdf5File::lock() {
  static std::recursive_mutex one_at_a_time;
  return Lock(one_at_a_time);
}

Hdf5File Hdf5File::create(const std::filesystem::path& path, std::size_t user_block) {
  Lock held = lock();
  quieten();
  const Hdf5Handle creation = properties(H5P_FILE_CREATE), how = access();
  H5Pset_userblock(creation.id(), user_block);
  H5Pset_obj_track_times(creation.id(), false);
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), how.id()), H5Fclose);
  if (!file.valid()) fail("write", path);
  return {path, std::move(file), std::move(held)};
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  Lock held = lock();
  quieten();
  const Hdf5Handle how = access();
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, how.id()), H5Fclose);
  if (!file.valid()) fail("read", path);
  return {path, std::move(file), std::move(held)};
}

void Hdf5File::write(const std::string& name, NumberKind kind, const void* values, std::size_t n) {
  const hsize_t size = n;
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose),
      links = properties(H5P_LINK_CREATE), creation = properties(H5P_DATASET_CREATE);
  H5Pset_create_intermediate_group(links.id(), 1);
  H5Pset_obj_track_times(creation.id(), false);  // the same state gives the same bytes
  Hdf5Handle data(
      H5Dcreate2(file_.id(), name.c_str(), type_of(kind), space.id(), links.id(), creation.id(), H5P_DEFAULT),
      H5Dclose);
  const bool written = data.valid() && (n == 0 || H5Dwrite(data.id(), type_of(kind), H5S_ALL, H5S_ALL,
                                                           H5P_DEFAULT, values) >= 0);
  if (!written || !data.close()) fail("write", path_);
}

Hdf5Handle Hdf5File::dataset(const std::string& name) const {
  Hdf5Handle data(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.valid()) throw FileError(fmt::format("{} lacks {}", path_.string(), name));
  return data;
}

std::size_t Hdf5File::length(const std::string& name) const {
  const Hdf5Handle data = dataset(name), space(H5Dget_space(data.id()), H5Sclose),
                   type(H5Dget_type(data.id()), H5Tclose);
  const hssize_t n = H5Sget_simple_extent_npoints(space.id());
  if (n < 0) fail("read", path_);
  const auto count = static_cast<std::size_t>(n);
  const std::size_t bytes = bytes_in_file(data.id());
  hsize_t all = 0;
  H5Fget_filesize(file_.id(), &all);
  if (bytes > all || count != bytes / std::max<std::size_t>(H5Tget_size(type.id()), 1))
    throw FileError(fmt::format("{}: {} says that it has {} entries, which are not in the file",
                                path_.string(), name, count));
  return count;
}

void Hdf5File::read(const std::string& name, NumberKind kind, void* values, std::size_t n) const {
  const std::size_t there = length(name);
  if (there != n)
    throw FileError(
        fmt::format("{}: {} has {} entries where {} were expected", path_.string(), name, there, n));
  const Hdf5Handle data = dataset(name), type(H5Dget_type(data.id()), H5Tclose);
  if (H5Tequal(type.id(), type_of(kind)) <= 0)
    throw FileError(fmt::format("{}: {} holds numbers of another type", path_.string(), name));
  if (n > 0 && H5Dread(data.id(), type_of(kind), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
    fail("read", path_);
}

void Hdf5File::close() {
  if (!file_.close()) fail("write", path_);
}

}  // namespace mpmfast
