#include "engine/output/vtu.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "engine/output/files.hpp"

namespace mpmfast {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;
constexpr int kFastest = 1;  // level 6 takes three times as long for 2 % less

/// VTK's layout: block count, block size, size of a last partial block (else 0), compressed sizes, the
/// blocks.
std::string compressed(std::string_view data) {
  const std::size_t blocks = (data.size() + kBlock - 1) / kBlock;
  std::vector<std::uint64_t> header{blocks, kBlock, data.size() % kBlock};
  header.resize(header.size() + blocks);
  const std::size_t head = header.size() * sizeof(std::uint64_t);
  std::vector<Bytef> packed(compressBound(kBlock));
  std::string out(head, '\0');
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::string_view block = data.substr(k * kBlock, kBlock);
    uLongf size = static_cast<uLongf>(packed.size());
    if (compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(block.data()),
                  static_cast<uLong>(block.size()), kFastest) != Z_OK)
      throw std::runtime_error("zlib could not compress a particle column");
    out.append(reinterpret_cast<const char*>(packed.data()), size);
    header[3 + k] = size;
  }
  std::memcpy(out.data(), header.data(), head);
  out.shrink_to_fit();
  return out;
}

}  // namespace

VtuFile::VtuFile(const std::vector<double>& points) : points_(points.size() / 3) {
  point_tag_ = array_tag("Float64", "Points", 3, {}, bytes_of(points));
  // A vertex cell for each point: ParaView shows cells, and its filters then work on single particles.
  constexpr std::uint8_t kVertex = 1;
  std::vector<std::int64_t> numbers(points_);
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  cell_tags_ = array_tag("Int64", "connectivity", 0, {}, bytes_of(numbers));
  std::iota(numbers.begin(), numbers.end(), std::int64_t{1});
  cell_tags_ += array_tag("Int64", "offsets", 0, {}, bytes_of(numbers));
  cell_tags_ += array_tag("UInt8", "types", 0, {}, bytes_of(std::vector<std::uint8_t>(points_, kVertex)));
}

std::string VtuFile::array_tag(std::string_view type, std::string_view name, std::size_t components,
                               std::span<const std::string_view> component_names, std::string_view data) {
  std::string tag = fmt::format("        <DataArray type=\"{}\" Name=\"{}\"", type, name);
  if (components > 1) tag += fmt::format(" NumberOfComponents=\"{}\"", components);
  for (std::size_t k = 0; k < component_names.size(); ++k)
    tag += fmt::format(" ComponentName{}=\"{}\"", k, component_names[k]);
  tag += fmt::format(" format=\"appended\" offset=\"{}\"/>\n", offset_);
  offset_ += appended_.emplace_back(compressed(data)).size();
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
                 "format=\"ascii\">{}</DataArray>\n    </FieldData>\n",
                 time);
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
