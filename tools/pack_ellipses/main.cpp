/// @file pack_ellipses: writes the picture of a box filled with ellipses (configs/ellipses.png).

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <string>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

#include "tools/pack_ellipses/packing.hpp"

namespace {

void report(const mpmfast::Packing& packing, const std::vector<unsigned char>& pixels) {
  const std::size_t n = packing.grains.size();
  const std::vector<double> gaps = mpmfast::all_gaps(packing.grains);
  double least = gaps.front(), least_same = gaps.front();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, gaps[i * n + j]);
      if (packing.grey[i] == packing.grey[j]) least_same = std::min(least_same, gaps[i * n + j]);
    }
  double thinnest = packing.grains.front().minor;
  for (const auto& grain : packing.grains) thinnest = std::min(thinnest, grain.minor);
  fmt::print("grains                        {}\n", n);
  fmt::print("area fraction                 {:.4f}\n", mpmfast::area_fraction(pixels));
  fmt::print("smallest gap                  {:.2f} pixels\n", least);
  fmt::print("smallest gap within one grey  {:.1f} pixels\n", least_same);
  fmt::print("thinnest grain                {:.1f} pixels across\n", 2 * thinnest);
}

}  // namespace

int main(int argc, char** argv) {
  mpmfast::PackingOptions options;
  std::string out = "ellipses.png";
  CLI::App app{
      "Fills a box with ellipses that do not overlap: a grey level for each of 20 materials, void white."};
  app.add_option("--seed", options.seed, "Number that chooses the packing")->capture_default_str();
  app.add_option("--width", options.width, "Pixels")->check(CLI::Range(10, 10000))->capture_default_str();
  app.add_option("--height", options.height, "Pixels")->check(CLI::Range(10, 10000))->capture_default_str();
  app.add_option("--fraction", options.fraction, "Share of the box that grains cover")
      ->check(CLI::Range(0.1, 0.9))
      ->capture_default_str();
  app.add_option("--out", out, "PNG file")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const mpmfast::Packing packing = mpmfast::pack(options);
    const std::vector<unsigned char> pixels = mpmfast::paint(packing);
    if (stbi_write_png(out.c_str(), options.width, options.height, 1, pixels.data(), options.width) == 0) {
      fmt::print(stderr, "cannot write {}\n", out);
      return 4;
    }
    report(packing, pixels);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
  return 0;
}
