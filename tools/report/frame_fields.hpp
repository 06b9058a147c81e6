#pragma once

/// @file Which scalars a page shows of a particle file, and their values.

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/output/read_vtu.hpp"

namespace mpmfast {

/// A particle file of which each array is unpacked once, however many fields are made of it.
class FrameFile {
 public:
  explicit FrameFile(const std::filesystem::path& path) : reader_(path) {}
  const VtuReader& reader() const { return reader_; }
  std::size_t size() const { return reader_.size(); }
  const std::vector<double>& values(const VtuArray& array) const;

 private:
  VtuReader reader_;
  mutable std::map<std::string, std::vector<double>> unpacked_;
};

/// A scalar of every particle: a component of an array, or what is made of all of them.
struct FrameField {
  /// domain: of F, times the share of the body's undeformed domain that the particle's is (of what was
  /// split).
  enum class Kind { component, magnitude, determinant, domain };
  std::string name, unit;
  std::string array;
  std::size_t component = 0;
  Kind kind = Kind::component;
  std::set<std::uint32_t> without{};  ///< bodies that have none of it

  /// NaN where the file has no such array, and for the bodies without.
  std::vector<double> values(const FrameFile& file) const;
};

/// Those of a file, the ones that are looked at most first.
/// @param picture  the field that the scene names
/// @param rigid    numbers of rigid bodies, which have a velocity and no stress or strain
std::vector<FrameField> frame_fields(const VtuReader& file, int dimension, const std::string& picture,
                                     const std::set<std::uint32_t>& rigid);

}  // namespace mpmfast
