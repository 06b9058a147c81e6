#include "engine/output/vtu.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "engine/output/files.hpp"

namespace mpmfast {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;
constexpr int kFastest = 1;  // level 6 takes three times as long for 2 % less

}  // namespace

void PackedArray::append(std::string_view data) {
  bytes_ += data.size();
  while (block_.size() + data.size() >= kBlock) {
    const std::size_t taken = kBlock - block_.size();
    block_ += data.substr(0, taken);
    data.remove_prefix(taken);
    pack();
  }
  block_ += data;
}

void PackedArray::pack() {
  std::vector<Bytef> buffer(compressBound(kBlock));
  uLongf size = static_cast<uLongf>(buffer.size());
  if (compress2(buffer.data(), &size, reinterpret_cast<const Bytef*>(block_.data()),
                static_cast<uLong>(block_.size()), kFastest) != Z_OK)
    throw std::runtime_error("zlib could not compress a particle column");
  packed_.emplace_back(reinterpret_cast<const char*>(buffer.data()), size);
  block_.clear();
}

std::vector<std::string> PackedArray::finish() {
  if (!block_.empty()) pack();
  std::vector<std::uint64_t> header{packed_.size(), kBlock, bytes_ % kBlock};
  for (const std::string& block : packed_) header.push_back(block.size());
  packed_.emplace(packed_.begin(), reinterpret_cast<const char*>(header.data()),
                  header.size() * sizeof(std::uint64_t));
  return std::move(packed_);
}

/// A vertex cell for each point: ParaView shows cells, and its filters then work on single particles.
void VtuFile::add_cells() {
  constexpr std::uint8_t kVertex = 1;
  const auto number = [](std::size_t i, std::int64_t* out) { *out = static_cast<std::int64_t>(i); };
  const auto end = [](std::size_t i, std::int64_t* out) { *out = static_cast<std::int64_t>(i) + 1; };
  const auto type = [](std::size_t, std::uint8_t* out) { *out = kVertex; };
  cell_tags_ = array_tag("Int64", "connectivity", 0, {}, packed<std::int64_t>(1, number));
  cell_tags_ += array_tag("Int64", "offsets", 0, {}, packed<std::int64_t>(1, end));
  cell_tags_ += array_tag("UInt8", "types", 0, {}, packed<std::uint8_t>(1, type));
}

std::string VtuFile::array_tag(std::string_view type, std::string_view name, std::size_t components,
                               std::span<const std::string_view> component_names, PackedArray data,
                               std::optional<std::size_t> tuples) {
  std::string tag = fmt::format("        <DataArray type=\"{}\" Name=\"{}\"", type, name);
  if (components > 1) tag += fmt::format(" NumberOfComponents=\"{}\"", components);
  if (tuples) tag += fmt::format(" NumberOfTuples=\"{}\"", *tuples);
  for (std::size_t k = 0; k < component_names.size(); ++k)
    tag += fmt::format(" ComponentName{}=\"{}\"", k, component_names[k]);
  tag += fmt::format(" format=\"appended\" offset=\"{}\"/>\n", offset_);
  for (std::string& part : data.finish()) offset_ += appended_.emplace_back(std::move(part)).size();
  return tag;
}

void VtuFile::write(const std::filesystem::path& path, double time) const {
  constexpr std::string_view order =
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out,
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n",
      order);
  fmt::format_to(out,
                 "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                 "format=\"ascii\">{}</DataArray>\n{}    </FieldData>\n",
                 time, field_data_);
  fmt::format_to(out, "    <Piece NumberOfPoints=\"{0}\" NumberOfCells=\"{0}\">\n", points_);
  fmt::format_to(out, "      <PointData>\n{}      </PointData>\n", point_data_);
  fmt::format_to(out, "      <Points>\n{}      </Points>\n", point_tag_);
  fmt::format_to(out, "      <Cells>\n{}      </Cells>\n", cell_tags_);
  text += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
  std::vector<std::string_view> parts{text};
  parts.insert(parts.end(), appended_.begin(), appended_.end());
  parts.emplace_back("\n  </AppendedData>\n</VTKFile>\n");
  write_aside(path, parts);
}

}  // namespace mpmfast
