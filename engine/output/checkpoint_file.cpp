#include "engine/output/checkpoint_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/descriptor.hpp"
#include "engine/output/files.hpp"
#include "engine/output/hash.hpp"

namespace mpmfast {
namespace {

constexpr std::size_t kSeal = 512;  ///< the least that HDF5 leaves space for
constexpr std::string_view kTitle = "mpmfast checkpoint\n";

/// Title, version, number of columns, length of the whole file, hash of what follows; zeros to the end.
std::string seal_text(int version, std::uint64_t columns, std::uint64_t bytes, const std::string& hash) {
  std::string text =
      fmt::format("{}version {}\ncolumns {}\nbytes {}\nxxh3_128 {}\n", kTitle, version, columns, bytes, hash);
  text.resize(kSeal, '\0');
  return text;
}

/// The hash of all bytes behind the seal, and how many there are with it.
struct Content {
  std::string hash;
  std::uint64_t bytes;
};

Content hash_content(const Descriptor& file, const std::filesystem::path& path) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::vector<char> block(kBlock);
  Hash128 hash;
  std::uint64_t at = kSeal;
  while (const std::size_t n = file.read_at(block.data(), kBlock, at, path)) {
    hash.add(block.data(), n);
    at += n;
  }
  return {hash.text(), at};
}

/// The number on the line "NAME NUMBER" of the seal; 0 when there is none.
std::uint64_t number_of(std::string_view seal, std::string_view name) {
  const std::size_t line = seal.find(fmt::format("\n{} ", name));
  std::uint64_t value = 0;
  if (line != std::string_view::npos)
    std::from_chars(seal.data() + line + name.size() + 2, seal.data() + seal.size(), value);
  return value;
}

/// @return the number of columns
std::uint64_t check_seal(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) -> FileError {
    return FileError(fmt::format("the checkpoint {} {}", path.string(), why));
  };
  const Descriptor file = Descriptor::open(path);
  std::array<char, kSeal> start{};
  const std::size_t there = file.read_at(start.data(), kSeal, 0, path);
  const std::string_view seal(start.data(), there);
  if (seal.substr(0, kTitle.size()) != kTitle.substr(0, there))
    throw refuse("is none of mpmfast, or its beginning was altered");
  if (there < kSeal) throw refuse(fmt::format("is truncated: {} bytes are left", there));
  const std::uint64_t version = number_of(seal, "version"), columns = number_of(seal, "columns"),
                      bytes = number_of(seal, "bytes");
  if (version != kCheckpointVersion)
    throw refuse(fmt::format("is of version {}; this program reads version {}", version, kCheckpointVersion));
  const Content content = hash_content(file, path);
  if (content.bytes < bytes)
    throw refuse(fmt::format("is truncated: {} of {} bytes are left", content.bytes, bytes));
  if (seal != seal_text(kCheckpointVersion, columns, content.bytes, content.hash))
    throw refuse("was altered or damaged: it is not what its checksum says");
  return columns;
}

}  // namespace

AsideFile::AsideFile(const std::filesystem::path& path) : path_(path), aside_(path) {
  aside_ += ".tmp";
  Descriptor::create(aside_);  // HDF5 would say less of why it cannot be made
}

AsideFile::~AsideFile() {
  std::error_code ignored;
  if (!done_) std::filesystem::remove(aside_, ignored);
}

void AsideFile::commit() {
  std::error_code error;
  std::filesystem::rename(aside_, path_, error);
  if (error) throw_file_error("write", path_, error.value());
  done_ = true;
  sync_folder(path_.parent_path());
}

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path)
    : aside_(path), file_(Hdf5File::create(aside_.path(), kSeal)) {}

void CheckpointWriter::keep(int version) {
  file_.close();
  const Descriptor file = Descriptor::open(aside_.path(), true);
  const Content content = hash_content(file, aside_.path());
  file.write_at(seal_text(version, columns_, content.bytes, content.hash), 0, aside_.path());
  file.sync(aside_.path());
  aside_.commit();
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path)
    : path_(path), columns_(check_seal(path)), file_(Hdf5File::open(path)) {}

void CheckpointReader::pass(const std::string& name, NumberKind kind, void* values, std::size_t n) {
  file_.read(name, kind, values, n);
  passed_.insert(name);
  if (kind != NumberKind::real) return;
  const auto* numbers = static_cast<const double*>(values);
  if (std::any_of(numbers, numbers + n, [](double x) { return std::isnan(x); }))
    throw FileError(fmt::format("the checkpoint {}: {} holds what is no number", path_.string(), name));
}

void CheckpointReader::finish() const {
  if (columns_ != passed_.size())
    throw FileError(fmt::format("the checkpoint {} holds {} columns, of which this program knows {}",
                                path_.string(), columns_, passed_.size()));
}

}  // namespace mpmfast
