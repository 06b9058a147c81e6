// Files of output byte by byte: animations as they are laid out, particle files whose tables are altered, and
// what a run may remove from a folder.

#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/animated_png.hpp"
#include "engine/output/descriptor.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/read_vtu.hpp"
#include "engine/output/vtu.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

std::string big_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(value >> (8 * k) & 255U);
  return out;
}

struct Chunk {
  std::string name, content;
};

/// The chunks behind the signature, whose check sums are right.
std::vector<Chunk> chunks_of(const std::string& file) {
  REQUIRE(file.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  std::vector<Chunk> out;
  for (std::size_t at = 8; at < file.size();) {
    std::size_t length = 0;
    for (std::size_t k = 0; k < 4; ++k) length = length << 8 | static_cast<unsigned char>(file[at + k]);
    REQUIRE(at + 12 + length <= file.size());
    out.push_back({file.substr(at + 4, 4), file.substr(at + 8, length)});
    const std::string named = out.back().name + out.back().content;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
    CHECK(file.substr(at + 8 + length, 4) == big_endian(sum, 4));
    at += 12 + length;
  }
  return out;
}

std::string unpacked(const std::string& data, std::size_t size) {
  std::string out(size + 1, '\0');
  uLongf length = static_cast<uLongf>(out.size());
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                     reinterpret_cast<const Bytef*>(data.data()), static_cast<uLong>(data.size())) == Z_OK);
  REQUIRE(length == size);
  out.resize(size);
  return out;
}

TEST_CASE(
    "an animation has a control chunk, and of each picture the box that changed, row by row as differences") {
  constexpr int kWidth = 300, kHeight = 7, kRate = 259;
  const TemporaryFolder folder;
  std::mt19937 random(1);
  AnimatedPng animation(kWidth, kHeight, kRate);
  std::vector<std::vector<std::uint8_t>> pictures;
  std::vector<std::uint8_t> pixels(3 * kWidth * kHeight);
  for (std::uint8_t& value : pixels) value = static_cast<std::uint8_t>(random());
  for (int k = 0; k < 30; ++k) {
    const int changes = k == 0 || k == 7 ? 0 : k == 8 ? 400 : 1 + k % 3;  // one picture is as the one before
    for (int n = 0; n < changes; ++n) pixels[random() % pixels.size()] ^= 0x55;
    if (k == 9) pixels.front() ^= 1;
    if (k == 10) pixels.back() ^= 1;
    pictures.push_back(pixels);
    animation.add(pixels);
  }
  animation.write(folder.path() / "a.png");
  const std::vector<Chunk> chunks = chunks_of(read_text(folder.path() / "a.png"));
  using namespace std::string_literals;
  REQUIRE(chunks.size() == 2 + 2 * pictures.size() + 1);
  CHECK(chunks[0].name == "IHDR");
  CHECK(chunks[0].content == big_endian(kWidth, 4) + big_endian(kHeight, 4) + "\x08\x02\0\0\0"s);
  CHECK(chunks[1].name == "acTL");
  CHECK(chunks[1].content == big_endian(pictures.size(), 4) + big_endian(0, 4));
  CHECK(chunks.back().name == "IEND");
  CHECK(chunks.back().content == "");
  std::uint64_t sequence = 0;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    CAPTURE(k);
    int left = kWidth, right = 0, top = kHeight, bottom = 0;
    const auto at = [](int x, int y) { return static_cast<std::size_t>(3 * (y * kWidth + x)); };
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (k == 0 ||
            !std::equal(&pictures[k][at(x, y)], &pictures[k][at(x, y)] + 3, &pictures[k - 1][at(x, y)])) {
          left = std::min(left, x), right = std::max(right, x + 1);
          top = std::min(top, y), bottom = std::max(bottom, y + 1);
        }
    if (left >= right) left = top = 0, right = bottom = 1;
    const int width = right - left, height = bottom - top;
    std::string control = big_endian(sequence++, 4);
    for (const int number : {width, height, left, top})
      control += big_endian(static_cast<std::uint64_t>(number), 4);
    CHECK(chunks[2 + 2 * k].name == "fcTL");
    CHECK(chunks[2 + 2 * k].content ==
          control + big_endian(1, 2) + big_endian(kRate, 2) + std::string(2, '\0'));
    const Chunk& data = chunks[3 + 2 * k];
    CHECK(data.name == (k == 0 ? "IDAT" : "fdAT"));
    if (k > 0) CHECK(data.content.substr(0, 4) == big_endian(sequence++, 4));
    const std::string rows =
        unpacked(data.content.substr(k == 0 ? 0 : 4), static_cast<std::size_t>((3 * width + 1) * height));
    std::string plain;
    for (int y = top; y < bottom; ++y) {
      plain += '\1';
      for (int x = left; x < right; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          plain +=
              static_cast<char>(pictures[k][at(x, y) + c] - (x > left ? pictures[k][at(x - 1, y) + c] : 0));
    }
    CHECK(rows == plain);
  }
}

/// What reading all of a file complains of.
std::string fault(const std::filesystem::path& path) {
  try {
    const VtuReader file(path);
    file.points();
    for (const VtuArray& array : file.point_data()) file.values(array);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

struct Vtu {
  explicit Vtu(const VtuFile& file) {
    file.write(path(), 1.5);
    text = read_text(path());
    data = text.find("\n_") + 2;
  }
  std::filesystem::path path() const { return folder.path() / "a.vtu"; }
  std::string fault_of(const std::string& altered) const {
    std::ofstream(path(), std::ios::binary) << altered;
    const std::string all = fault(path()), begin = "cannot read " + path().string() + ": ";
    if (all.empty()) return "";
    REQUIRE(all.starts_with(begin));
    return all.substr(begin.size());
  }
  std::string fault_with(const std::string& from, const std::string& to) const {
    std::string altered = text;
    REQUIRE(altered.find(from) != std::string::npos);
    return fault_of(altered.replace(altered.find(from), from.size(), to));
  }
  std::size_t offset_of(const std::string& name) const {
    const std::size_t tag = text.find("offset=\"", text.find("Name=\"" + name + "\""));
    return data + std::stoul(text.substr(tag + 8));
  }
  std::uint64_t word(std::size_t at) const {
    std::uint64_t out = 0;
    std::memcpy(&out, &text[at], 8);
    return out;
  }
  static void set(std::string& altered, std::size_t at, std::uint64_t value) {
    std::memcpy(&altered[at], &value, 8);
  }
  std::size_t end() const { return text.size() - std::string("\n  </AppendedData>\n</VTKFile>\n").size(); }

  TemporaryFolder folder;
  std::string text;
  std::size_t data = 0;
};

TEST_CASE("a particle file of another kind is refused, whichever word of its head says so") {
  const Vtu vtu(VtuFile(std::vector<double>{1, 2, 3}));
  REQUIRE(vtu.fault_of(vtu.text) == "");
  const std::string kind = "not in the format of a run's particle files (of another program or machine?)";
  CHECK(vtu.fault_with("type=\"UnstructuredGrid\"", "type=\"PolyData\"") == kind);
  CHECK(vtu.fault_with("LittleEndian", "BigEndian") == kind);
  CHECK(vtu.fault_with("header_type=\"UInt64\"", "header_type=\"UInt32\"") == kind);
  CHECK(vtu.fault_with("vtkZLibDataCompressor", "vtkLZ4DataCompressor") == kind);
  for (const char* time : {"", "x", "nan", "inf", "1.5 s"})
    CHECK(vtu.fault_with("1.5</DataArray>", std::string(time) + "</DataArray>") ==
          "its TimeValue is no number");
  CHECK(vtu.fault_with("NumberOfPoints=\"1\"", "NumberOfPoints=\"one\"") ==
        "its number of points is no number");
  CHECK(vtu.fault_with("Name=\"Points\"", "Name=\"Places\"") == "no array 'Points' of Float64");
  CHECK(vtu.fault_with("NumberOfComponents=\"3\"", "NumberOfComponents=\"1\"")
            .starts_with("the data of 'Points'"));
}

TEST_CASE(
    "the tables before the blocks of an array are believed as far as the file goes, and not a byte farther") {
  VtuFile file(std::vector<double>{1, 2, 3, 4, 5, 6});
  file.add_point_data("last", std::vector<double>{7, 8});
  const Vtu vtu(file);
  REQUIRE(vtu.fault_of(vtu.text) == "");
  const auto altered = [&](const std::string& name, std::vector<std::uint64_t> words) {
    std::string text = vtu.text;
    for (std::size_t k = 0; k < words.size(); ++k) Vtu::set(text, vtu.offset_of(name) + 8 * k, words[k]);
    return vtu.fault_of(text);
  };
  for (const std::string name : {"Points", "connectivity", "last"}) {
    CAPTURE(name);
    const std::string cut = "the data of '" + name + "' are cut short or altered";
    const std::size_t at = vtu.offset_of(name);
    const std::uint64_t count = vtu.word(at), size = vtu.word(at + 8), last = vtu.word(at + 16),
                        packed = vtu.word(at + 24);
    CHECK(count == 1);
    CHECK(last == (name == "Points" ? 48 : 16));
    const std::uint64_t rest = vtu.end() - (at + 32);  // behind the table
    CHECK(packed <= rest);
    CHECK(altered(name, {count, size, last, rest + 1}) == cut);
    CHECK(altered(name, {count, size, last, rest}) == "");  // what follows a block's end is not looked at
    CHECK(altered(name, {count, size, last + 1}) == cut);
    CHECK(altered(name, {count, size, last - 1}) == cut);
    CHECK(altered(name, {0, size, last}) == cut);
    CHECK(altered(name, {2, size, last}) == cut);
    CHECK(altered(name, {count, std::uint64_t{1} << 32, last}) == "");
    CHECK(altered(name, {count, (std::uint64_t{1} << 32) + 1, last}) == cut);
    CHECK(altered(name, {count, last, 0}) == "");  // the one block is whole
    const std::uint64_t most = (vtu.end() - (at + 24)) / 8;
    CHECK(altered(name, {most + 1, 0, last}) == cut);
    // Bits of the block itself.
    if (name != "connectivity") {
      std::string text = vtu.text;
      text[at + 32 + packed - 1] ^= 1;
      CHECK(vtu.fault_of(text) == "the data of '" + name + "' are altered: they do not unpack");
    }
  }
}

TEST_CASE("of an array in blocks the last one ends where the file does at the latest") {
  constexpr std::size_t kPoints = 140000;  // more than one block of doubles
  VtuFile file(kPoints, [](std::size_t, double* x) { x[0] = x[1] = x[2] = 0; });
  file.add_point_data("last", std::vector<double>(kPoints, 1.0));
  const Vtu vtu(file);
  const std::size_t at = vtu.offset_of("last");
  REQUIRE(vtu.word(at) == 2);
  const std::uint64_t rest = vtu.end() - (at + 40) - vtu.word(at + 24);
  std::string text = vtu.text;
  Vtu::set(text, at + 32, rest + 1);
  CHECK(vtu.fault_of(text) == "the data of 'last' are cut short or altered");
}

TEST_CASE("arrays of a whole file have 64 components at most, and none need a point") {
  for (const std::size_t components : {1U, 64U, 65U}) {
    VtuFile file(std::vector<double>{});
    file.add_field_data("many", std::vector<double>(2 * components, 0.5), components);
    const Vtu vtu(file);
    CHECK(vtu.fault_of(vtu.text) ==
          (components <= 64 ? "" : "an array of its FieldData is not as a run writes it"));
    if (components <= 64) CHECK(VtuReader(vtu.path()).find_of_file("many")->tuples == 2);
    if (components == 1)
      for (const char* tuples : {"3", "1", "0", "18446744073709551615"})
        CHECK(vtu.fault_with("NumberOfTuples=\"2\"", "NumberOfTuples=\"" + std::string(tuples) + "\"") ==
              "the data of 'many' are cut short or altered");
  }
}

TEST_CASE("each frame of a series has a time that is a number and a file") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "particles.pvd";
  const auto read = [&](const std::string& attributes) {
    std::ofstream(path)
        << "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0.5\" file=\"first\"/><DataSet " +
               attributes + "/></Collection></VTKFile>";
    try {
      const auto frames = read_pvd(path);
      return std::to_string(frames.at(1).time) + " " + frames.at(1).file.filename().string();
    } catch (const FileError& error) {
      return std::string(error.what());
    }
  };
  CHECK(read("timestep=\"-2\" file=\"b\"") == "-2.000000 b");
  const std::string wrong = "cannot read " + path.string() + ": its frame 1 has no time or no file";
  for (const char* attributes :
       {"", "timestep=\"1\"", "file=\"b\"", "timestep=\"nan\" file=\"b\"", "timestep=\"inf\"",
        "timestep=\"1s\" file=\"b\"", "timestep=\"1\" file=\"\""})
    CHECK(read(attributes) == wrong);
}

TEST_CASE("with force a folder loses the files whose names a run gives, and keeps all others") {
  const TemporaryFolder temporary;
  const auto folder = temporary.path() / "run";
  const Scene scene = small_scene(Space::plane_strain);
  std::set<std::string> ours{"run.json", "run.log",    "history.csv",   "particles.pvd",
                             "grid.pvd", "failed.vtu", "checkpoint.h5", "report.html"},
      theirs{"run.jsonx",
             "xrun.log",
             "history.csv.bak",
             "notes.txt",
             ".png",
             "plot_.png",
             "picture_first_.png",
             "plot",
             "plot_energy",
             "plot_energy.txt",
             "plot_energies.png",
             "plot_speed.svg",
             "picture_middle_speed.png",
             "picture_first_speed.svg",
             "picture_first_speed_000000.png",
             "plot_speed_00000.png",
             "plot_speed_00000a.png",
             "plot_speed_000/00",
             "plot_nothing_000000.png",
             "plot_speed000000.png",
             "Plot_speed.png",
             "particles.vtu",
             "000000.vtu"};
  theirs.erase("plot_speed_000/00");
  for (const int dimension : {2, 3})
    for (const std::string& field : field_names(dimension))
      for (const std::string& name : {"picture_first_" + field, "picture_last_" + field, "plot_" + field,
                                      "plot_" + field + "_000000", "plot_" + field + "_1234567"})
        ours.insert(name + ".png");
  for (const char* stem : {"energy", "momentum", "stress", "force", "stress_strain", "columns"})
    for (const char* format : {".png", ".svg", ".pdf"}) ours.insert("plot_" + std::string(stem) + format);
  for (const std::string series : {"particles/", "grid/"}) {
    for (const char* name : {"000000.vtu", "123456.vtu", "1234567.vtu", "999999.vtu"})
      ours.insert(series + name);
    for (const char* name : {"00000.vtu", "00000a.vtu", "000000.vtk", "x000000.vtu", "000000"})
      theirs.insert(series + name);
  }
  for (const std::string& name : std::vector<std::string>(ours.begin(), ours.end()))
    ours.insert(name + ".tmp");
  const auto fill = [&] {
    for (const auto* names : {&ours, &theirs})
      for (const std::string& name : *names) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::ofstream(folder / name) << "x";
      }
  };
  const auto left = [&] {
    std::set<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) out.insert(entry.path().lexically_relative(folder).string());
    return out;
  };
  fill();
  prepare_folder(folder, scene, true);
  auto expected = theirs;
  expected.insert("scene.yaml");
  CHECK(left() == expected);
  // One that goes on loses what the end of the last part wrote, and what is half written.
  fill();
  reopen_folder(folder);
  for (const std::string& name : ours)
    if (!name.ends_with(".tmp") && name != "run.json" && name != "failed.vtu") expected.insert(name);
  CHECK(left() == expected);
  // Folders of series that are empty go too.
  for (const char* series : {"particles", "grid"}) std::filesystem::remove_all(folder / series);
  std::filesystem::create_directories(folder / "grid");
  std::ofstream(folder / "grid" / "000001.vtu") << "x";
  prepare_folder(folder, scene, true);
  CHECK_FALSE(std::filesystem::exists(folder / "grid"));
}

TEST_CASE(
    "a folder whose history another one holds is left alone, and no folder or link is taken for a history") {
  const TemporaryFolder temporary;
  const Scene scene = small_scene(Space::plane_strain);
  const auto folder = temporary.path() / "run";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "history.csv") << "x";
  {
    const Descriptor held = Descriptor::open(folder / "history.csv", true);
    REQUIRE(held.claim());
    for (const bool force : {false, true})
      CHECK_THROWS_WITH_AS(prepare_folder(folder, scene, force),
                           (folder.string() + " belongs to a run that goes on now").c_str(), FileError);
    CHECK(read_text(folder / "history.csv") == "x");
  }
  CHECK_NOTHROW(prepare_folder(folder, scene, true));
  std::filesystem::create_directory(folder / "history.csv");
  CHECK_NOTHROW(prepare_folder(folder, scene, true));
  CHECK(std::filesystem::is_directory(folder / "history.csv"));
  CHECK_NOTHROW(reopen_folder(folder));  // without series
}

TEST_CASE("a folder proves by one of four files, or by its scene, that a run was there") {
  const Scene scene = small_scene(Space::plane_strain);
  for (const std::string name :
       {"run.json", "run.log", "history.csv", "checkpoint.h5", "scene.yaml.tmp", "scene.yaml",
        "particles.pvd", "grid.pvd", "failed.vtu", "report.html", "notes"}) {
    CAPTURE(name);
    const TemporaryFolder temporary;
    const auto folder = temporary.path() / "run";
    std::filesystem::create_directory(folder);
    std::ofstream(folder / name) << (name == "scene.yaml" ? "title: another\n" : "x");
    const bool proof = name == "run.json" || name == "run.log" || name == "history.csv" ||
                       name == "checkpoint.h5" || name == "scene.yaml.tmp";
    if (proof) {
      CHECK_NOTHROW(prepare_folder(folder, scene, true));
    } else {
      CHECK_THROWS_WITH_AS(
          prepare_folder(folder, scene, true),
          (folder.string() + " holds no run (none of run.json, run.log, history.csv, checkpoint.h5), "
                             "and --force replaces nothing else")
              .c_str(),
          FileError);
      CHECK(std::filesystem::exists(folder / name));
    }
    if (name != "scene.yaml") continue;
    std::ofstream(folder / name) << scene.resolved_yaml;  // the same scene: killed as it began
    CHECK_NOTHROW(prepare_folder(folder, scene, true));
  }
}

}  // namespace
