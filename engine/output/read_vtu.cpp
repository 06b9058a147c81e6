#include "engine/output/read_vtu.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <pugixml.hpp>
#include <system_error>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"

namespace mpmfast {
namespace {

constexpr std::string_view kEnd = "\n  </AppendedData>\n</VTKFile>\n";
constexpr std::string_view kByteOrder =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
// Deflate packs at most 1032 bytes into one: a size beyond that is made up, and is not allocated.
constexpr std::uint64_t kMostPacked = 1032;
constexpr std::uint64_t kMostComponents = 64;
constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 32;  // ours are of 1 MiB

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("cannot read {}: {}", path.string(), why));
}

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) refuse_file(path, "no such file");
  if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "it is no regular file");
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw_file_error("read", path);
  std::string text(static_cast<std::size_t>(file.tellg()), '\0');
  file.seekg(0);
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size()))) throw_file_error("read", path);
  return text;
}

/// The whole text is a number.
template <class Number>
bool read_number(std::string_view text, Number& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

std::uint64_t bytes_of_type(std::string_view type) {
  if (type == "Float64" || type == "Int64") return 8;
  if (type == "Float32" || type == "UInt32") return 4;
  if (type == "UInt16") return 2;
  return type == "UInt8" ? 1 : 0;
}

/// Nothing where the tag is none of an array that our runs write.
bool read_array_tag(const pugi::xml_node& tag, VtuArray& array) {
  array.name = tag.attribute("Name").value();
  array.type = tag.attribute("type").value();
  const std::string_view components = tag.attribute("NumberOfComponents").as_string("1");
  if (array.name.empty() || bytes_of_type(array.type) == 0 || !read_number(components, array.components) ||
      array.components < 1 || array.components > kMostComponents ||
      tag.attribute("format").value() != std::string_view("appended") ||
      !read_number(std::string_view(tag.attribute("offset").value()), array.offset))
    return false;
  for (std::size_t k = 0; k < array.components; ++k) {
    const auto name = tag.attribute(fmt::format("ComponentName{}", k).c_str());
    if (name) array.names.emplace_back(name.value());
  }
  return array.names.empty() || array.names.size() == array.components;
}

std::uint64_t integer_at(std::string_view data, std::uint64_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, data.data() + at, sizeof(value));
  return value;
}

constexpr std::uint64_t kWord = sizeof(std::uint64_t);

/// VTK's table before the blocks of an array: how many, the size of each and of a last partial one (else 0);
/// the packed sizes follow, then the blocks.
struct Blocks {
  Blocks(std::string_view data, std::uint64_t offset)
      : count(integer_at(data, offset)),
        size(integer_at(data, offset + kWord)),
        last(integer_at(data, offset + 2 * kWord)),
        sizes(offset + 3 * kWord) {}
  std::uint64_t unpacked(std::uint64_t block) const { return block + 1 == count && last != 0 ? last : size; }
  std::uint64_t packed(std::string_view data, std::uint64_t block) const {
    return integer_at(data, sizes + block * kWord);
  }
  std::uint64_t begin() const { return sizes + count * kWord; }

  std::uint64_t count, size, last, sizes;
};

}  // namespace

VtuReader::VtuReader(const std::filesystem::path& path) : path_(path), text_(read_whole_file(path)) {
  read_header();
}

void VtuReader::refuse(const std::string& why) const { refuse_file(path_, why); }

void VtuReader::read_header() {
  constexpr std::string_view tag = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t at = text_.find(tag);
  if (at == std::string::npos) refuse("not a particle file of a run, or cut short in its header");
  const std::string_view text = text_;
  if (text.size() < at + tag.size() + kEnd.size() || text.substr(text.size() - kEnd.size()) != kEnd)
    refuse("cut short: its end is missing");
  appended_ = text.substr(at + tag.size(), text.size() - kEnd.size() - at - tag.size());
  const std::string header = text_.substr(0, at) + "</VTKFile>";
  pugi::xml_document document;
  if (const auto parsed = document.load_buffer(header.data(), header.size()); !parsed)
    refuse(fmt::format("its header is no XML ({} at byte {})", parsed.description(), parsed.offset));
  const auto file = document.child("VTKFile");
  const auto is = [&](const char* name, std::string_view value) {
    return file.attribute(name).value() == value;
  };
  if (!is("type", "UnstructuredGrid") || !is("byte_order", kByteOrder) || !is("header_type", "UInt64") ||
      !is("compressor", "vtkZLibDataCompressor"))
    refuse("not in the format of a run's particle files (of another program or machine?)");
  const auto grid = file.child("UnstructuredGrid"), piece = grid.child("Piece");
  const auto time_tag = grid.child("FieldData").child("DataArray");
  const std::string_view time = time_tag.child_value();
  if (!read_number(time, time_) || !std::isfinite(time_)) refuse("its TimeValue is no number");
  if (!read_number(std::string_view(piece.attribute("NumberOfPoints").value()), size_))
    refuse("its number of points is no number");
  const auto read_array = [&](const pugi::xml_node& node, const char* group, std::size_t tuples) {
    VtuArray array;
    array.tuples = tuples;
    if (!read_array_tag(node, array))
      refuse(fmt::format("an array of its {} is not as a run writes it", group));
    checked_bytes(array);
    return array;
  };
  const auto read_arrays = [&](const char* group, std::vector<VtuArray>& arrays) {
    for (const auto& node : piece.child(group).children("DataArray"))
      arrays.push_back(read_array(node, group, size_));
  };
  for (auto node = time_tag.next_sibling("DataArray"); node; node = node.next_sibling("DataArray")) {
    std::size_t tuples = 0;
    if (!read_number(std::string_view(node.attribute("NumberOfTuples").value()), tuples))
      refuse("the length of an array of its FieldData is no number");
    of_file_.push_back(read_array(node, "FieldData", tuples));
  }
  read_arrays("PointData", point_data_);
  read_arrays("Points", others_);
  read_arrays("Cells", others_);
  if (checked(find("Points"), "Points", "Float64").components != 3)
    refuse("its points have no three coordinates");
}

const VtuArray* VtuReader::find(std::string_view name) const {
  for (const auto* arrays : {&point_data_, &others_})
    for (const VtuArray& array : *arrays)
      if (array.name == name) return &array;
  return nullptr;
}

const VtuArray* VtuReader::find_of_file(std::string_view name) const {
  for (const VtuArray& array : of_file_)
    if (array.name == name) return &array;
  return nullptr;
}

const VtuArray& VtuReader::checked(const VtuArray* array, std::string_view name,
                                   std::string_view type) const {
  if (array == nullptr || array->type != type) refuse(fmt::format("no array '{}' of {}", name, type));
  return *array;
}

std::vector<double> VtuReader::values(const VtuArray& array) const {
  if (array.type == "Float64") return unpack<double>(array);
  if (array.type == "Float32") return widened<float>(array);
  if (array.type == "UInt8") return widened<std::uint8_t>(array);
  if (array.type == "UInt16") return widened<std::uint16_t>(array);
  if (array.type == "UInt32") return widened<std::uint32_t>(array);
  return widened<std::int64_t>(array);
}

std::uint64_t VtuReader::checked_bytes(const VtuArray& array) const {
  const auto wrong = [&] { refuse(fmt::format("the data of '{}' are cut short or altered", array.name)); };
  const std::uint64_t available = appended_.size();
  const std::uint64_t tuple = bytes_of_type(array.type) * array.components;
  if (array.tuples > kMostPacked * available / tuple || array.offset > available ||
      available - array.offset < 3 * kWord)
    wrong();
  const std::uint64_t bytes = array.tuples * tuple;
  const Blocks blocks(appended_, array.offset);
  if (blocks.count > (available - blocks.sizes) / kWord || blocks.size > kLargestBlock ||
      blocks.last > kLargestBlock)
    wrong();
  std::uint64_t at = blocks.begin(), unpacked = 0;
  for (std::uint64_t b = 0; b < blocks.count; ++b) {
    if (blocks.packed(appended_, b) > available - at) wrong();
    at += blocks.packed(appended_, b);
    unpacked += blocks.unpacked(b);
    if (unpacked > bytes) wrong();
  }
  if (unpacked != bytes) wrong();
  return bytes;
}

void VtuReader::unpack_bytes(const VtuArray& array, unsigned char* out) const {
  const Blocks blocks(appended_, array.offset);
  std::uint64_t at = blocks.begin();
  for (std::uint64_t b = 0; b < blocks.count; ++b) {
    uLongf size = blocks.unpacked(b);
    const auto packed = static_cast<uLong>(blocks.packed(appended_, b));
    if (uncompress(out, &size, reinterpret_cast<const Bytef*>(appended_.data() + at), packed) != Z_OK ||
        size != blocks.unpacked(b))
      refuse(fmt::format("the data of '{}' are altered: they do not unpack", array.name));
    at += packed;
    out += size;
  }
}

std::vector<SeriesFrame> read_pvd(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  pugi::xml_document document;
  if (const auto parsed = document.load_buffer(text.data(), text.size()); !parsed)
    refuse_file(path, fmt::format("it is no XML ({} at byte {})", parsed.description(), parsed.offset));
  const auto file = document.child("VTKFile");
  if (file.attribute("type").value() != std::string_view("Collection"))
    refuse_file(path, "not a series of particle files");
  std::vector<SeriesFrame> frames;
  for (const auto& node : file.child("Collection").children("DataSet")) {
    SeriesFrame frame;
    const std::string_view time = node.attribute("timestep").value();
    const std::string name = node.attribute("file").value();
    if (!read_number(time, frame.time) || !std::isfinite(frame.time) || name.empty())
      refuse_file(path, fmt::format("its frame {} has no time or no file", frames.size()));
    frame.file = path.parent_path() / name;
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace mpmfast
