#include <fmt/format.h>

#include <system_error>

#include "engine/output/files.hpp"
#include "engine/output/output.hpp"

namespace mpmfast {

FrameSeries::FrameSeries(const std::filesystem::path& folder, std::string name, std::vector<double> times)
    : folder_(folder), name_(std::move(name)), times_(std::move(times)) {
  make_folder(folder_ / name_);
  if (times_.empty()) return;
  list();
  std::error_code error;
  for (std::size_t k = times_.size(); std::filesystem::remove(file(k), error); ++k) {
  }
  if (error) throw_file_error("remove frames from", folder_ / name_, error.value());
}

std::filesystem::path FrameSeries::next() const { return file(times_.size()); }

void FrameSeries::add(double time) {
  times_.push_back(time);
  list();
}

std::filesystem::path FrameSeries::file(std::size_t number) const {
  return folder_ / name_ / fmt::format("{:06}.vtu", number);
}

void FrameSeries::list() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t k = 0; k < times_.size(); ++k)
    text +=
        fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}/{:06}.vtu\"/>\n", times_[k], name_, k);
  write_aside(folder_ / (name_ + ".pvd"), text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace mpmfast
