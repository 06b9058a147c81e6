#include <doctest/doctest.h>

#include <sys/resource.h>

#include <csignal>
#include <limits>

#include "engine/errors.hpp"
#include "engine/output/checkpoint_file.hpp"
#include "tests/sanitized.hpp"
#include "tests/text.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;
using mpmfast::test::holds;

namespace {

struct Sample {
  double real = -0.0;
  std::uint64_t whole = ~std::uint64_t{0};
  int number = -7;
  bool flag = true;
  std::vector<double> reals{0.1, -std::numeric_limits<double>::infinity(), 5e-324};
  std::vector<std::uint16_t> shorts = std::vector<std::uint16_t>(5000, 3);
  std::vector<std::uint32_t> nothing;
  std::string text = "a \"name\", with é";

  void visit(Archive& archive) {
    archive.number("group/real", real);
    archive.number("group/whole", whole);
    archive.number("number", number);
    archive.flag("flag", flag);
    archive.list("group/deeper/reals", reals);
    archive.list("shorts", shorts);
    archive.list("nothing", nothing);
    archive.list("text", text);
  }
};

void write(const std::filesystem::path& path, Sample sample = {}, int version = kCheckpointVersion) {
  CheckpointWriter file(path);
  sample.visit(file);
  file.keep(version);
}

/// What reading the file complains of; nothing when it is good.
std::string complaint(const std::filesystem::path& path) {
  try {
    Sample sample;
    CheckpointReader file(path);
    sample.visit(file);
    file.finish();
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// No file may grow beyond so many bytes: for the program the same as a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

}  // namespace

TEST_CASE("a checkpoint gives back every bit of what was written, and the same state the same file") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "checkpoint.h5";
  write(path);
  Sample back;
  back.real = back.number = 1;
  back.whole = 0;
  back.flag = false;
  back.reals = {9, 9, 9, 9, 9};
  back.nothing = {1};
  back.shorts.clear();
  back.text.clear();
  CheckpointReader file(path);
  back.visit(file);
  file.finish();
  const Sample sample;
  CHECK(std::signbit(back.real));
  CHECK(back.whole == sample.whole);
  CHECK(back.number == sample.number);
  CHECK(back.flag);
  REQUIRE(back.reals.size() == 3);
  CHECK(std::memcmp(back.reals.data(), sample.reals.data(), 3 * sizeof(double)) == 0);
  CHECK(back.shorts == sample.shorts);
  CHECK(back.nothing.empty());
  CHECK(back.text == sample.text);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "checkpoint.h5.tmp"));
  write(folder.path() / "again.h5");
  CHECK(read_text(path) == read_text(folder.path() / "again.h5"));
}

TEST_CASE("a checkpoint that is truncated, altered anywhere or of another version is refused") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "checkpoint.h5";
  CHECK(holds(complaint(path), "No such file"));
  write(path);
  REQUIRE(complaint(path) == "");
  const std::string good = read_text(path);
  for (const std::size_t left : {std::size_t{0}, std::size_t{7}, std::size_t{511}, std::size_t{512},
                                 good.size() / 2, good.size() - 1}) {
    write_text(path, good.substr(0, left));
    CHECK_MESSAGE(holds(complaint(path), "is truncated"), left);
  }
  const std::size_t part = mpmfast::test::sanitized() ? 8 : 1;
  for (std::size_t at = 0; at < good.size(); at += part * (at < 600 ? 1 : 89))
    for (const int bit : {1, 64}) {
      std::string altered = good;
      altered[at] = static_cast<char>(altered[at] ^ bit);
      write_text(path, altered);
      REQUIRE_MESSAGE(complaint(path) != "", at);
    }
  write_text(path, good + "x");
  CHECK(holds(complaint(path), "was altered or damaged"));
  write_text(path, "title: a scene\n");
  CHECK(holds(complaint(path), "is none of mpmfast"));
  write(path, {}, kCheckpointVersion + 1);
  CHECK(holds(complaint(path), "is of version " + std::to_string(kCheckpointVersion + 1) +
                                   "; this program reads version " + std::to_string(kCheckpointVersion)));
}

TEST_CASE("a checkpoint with other columns than the program's is refused") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "checkpoint.h5";
  const auto read = [&](auto visit) {
    try {
      CheckpointReader file(path);
      visit(file);
      file.finish();
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  write(path);
  double real = 0, pair[2];
  int number = 0;
  CHECK(holds(read([&](Archive& a) { a.number("group/real", real); }),
              "holds 8 columns, of which this program knows 1"));
  CHECK(holds(read([&](Archive& a) { a.number("unreal", real); }), "lacks unreal"));
  CHECK(holds(read([&](Archive& a) { a.column("group/real", pair, 2); }),
              "group/real has 1 entries where 2 were expected"));
  CHECK(holds(read([&](Archive& a) { a.number("group/real", number); }), "numbers of another type"));
}

TEST_CASE("a checkpoint that cannot be written leaves the last one, and nothing of itself") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "checkpoint.h5", aside = folder.path() / "checkpoint.h5.tmp";
  write(path);
  const std::string good = read_text(path);
  {
    CheckpointWriter unfinished(path);
    Sample().visit(unfinished);
    CHECK(std::filesystem::exists(aside));
  }
  CHECK_FALSE(std::filesystem::exists(aside));
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{600}, rlim_t{4096}, rlim_t{9000}}) {
    const FullDisk disk(bytes);
    Sample large;
    large.reals.assign(20000, 1.5);
    std::string message;
    try {
      write(path, large);
    } catch (const FileError& error) {
      message = error.what();
    }
    CHECK_MESSAGE(holds(message, "File too large"), bytes, ": ", message);
    CHECK_FALSE(std::filesystem::exists(aside));
  }
  CHECK(read_text(path) == good);
  CHECK_THROWS_AS(write(folder.path() / "nowhere" / "checkpoint.h5"), FileError);
}

TEST_CASE(
    "history.csv stays whole on a full disk, belongs to one process, and is cut to what a checkpoint knows") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "history.csv";
  const Scene scene = small_scene(Space::plane_strain);
  HistoryRow row;
  const auto append = [&](HistoryFile& file, std::uint64_t step) {
    row.step = step;
    file.append(row);
  };
  std::string three;
  HistoryMark third, fifth;
  {
    HistoryFile file(folder.path(), scene);
    for (const std::uint64_t step : {0, 10, 25}) append(file, step);
    three = read_text(path);
    third = file.mark();
    CHECK(third.rows == 3);
    CHECK(third.last_step == 25);
    CHECK(third.hash == text_hash(three));
    // The other one still writes.
    CHECK_THROWS_AS(HistoryFile(folder.path(), scene, third), FileError);
    CHECK_THROWS_AS(HistoryFile(folder.path(), scene), FileError);
    CHECK(read_text(path) == three);
    const FullDisk disk(three.size() + 20);
    CHECK_THROWS_AS(append(file, 31), FileError);
    CHECK(read_text(path) == three);
  }
  {
    HistoryFile file(folder.path(), scene, third);
    CHECK(read_text(path) == three);
    append(file, 31);
    append(file, 32);
    fifth = file.mark();
    CHECK(fifth.hash == text_hash(read_text(path)));
  }
  write_text(path, read_text(path) + "33,torn");
  HistoryFile(folder.path(), scene, fifth);
  {
    HistoryFile file(folder.path(), scene, third);
    CHECK(read_text(path) == three);
  }
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, fifth), FileError);
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, {4, 31, third.hash}), FileError);
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, {3, 26, third.hash}), FileError);
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, {2, 1, third.hash}), FileError);
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, {3, 25, ""}), FileError);
  CHECK(read_text(path) == three);
  for (std::size_t at = 0; at < three.size(); ++at) {  // a digit, a comma, a name: one byte is enough
    std::string edited = three;
    edited[at] ^= 1;
    write_text(path, edited);
    CHECK_THROWS_AS(HistoryFile(folder.path(), scene, third), FileError);
    REQUIRE(read_text(path) == edited);
  }
  write_text(path, three);
  HistoryFile file(folder.path(), scene, third);
  std::filesystem::remove(path);
  CHECK_THROWS_AS(append(file, 31), FileError);
  CHECK_THROWS_AS(file.sync(), FileError);
  CHECK_THROWS_AS(HistoryFile(folder.path(), scene, third), FileError);
}

TEST_CASE("a long history goes on from any of its rows") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "history.csv";
  const Scene scene = small_scene(Space::plane_strain);
  HistoryRow row;
  constexpr std::uint64_t kRows = 3000;
  struct State {
    HistoryMark mark;
    std::string text;
  };
  std::vector<State> states;
  {
    HistoryFile file(folder.path(), scene);
    for (std::uint64_t k = 0; k <= kRows; ++k) {
      if (k % 600 == 0) states.push_back({file.mark(), read_text(path)});
      row.step = 7 * k;
      file.append(row);
    }
  }
  const std::string whole = read_text(path);
  REQUIRE(whole.size() > std::size_t{3} << 16);  // of what is read at a time
  for (const State& state : states) {
    write_text(path, whole);
    HistoryFile file(folder.path(), scene, state.mark);
    CHECK(read_text(path) == state.text);
    CHECK(file.mark().hash == state.mark.hash);
    row.step = 7 * state.mark.rows;
    file.append(row);
    CHECK(whole.starts_with(read_text(path)));
    CHECK(file.mark().hash == text_hash(read_text(path)));
  }
}

TEST_CASE("a particle series that goes on loses later frames, and a reopened folder what a kill left") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  const auto particles = particles_in_order<2>(ascending(10));
  std::string two;
  {
    ParticleSeries<2> series(folder.path(), scene);
    series.append(particles, 0);
    series.append(particles, 0.1);
    two = read_text(folder.path() / "particles.pvd");
    for (const double time : {0.2, 0.3, 0.4}) series.append(particles, time);
  }
  for (const char* name :
       {"particles/000003.vtu.tmp", "particles.pvd.tmp", "checkpoint.h5.tmp", "run.json", "mine.tmp"})
    write_text(folder.path() / name, "x");
  reopen_folder(folder.path());
  ParticleSeries<2> series(folder.path(), scene, {0, 0.1});
  CHECK(read_text(folder.path() / "particles.pvd") == two);
  for (const char* gone : {"particles/000002.vtu", "particles/000003.vtu", "particles/000004.vtu",
                           "particles/000003.vtu.tmp", "particles.pvd.tmp", "checkpoint.h5.tmp", "run.json"})
    CHECK_MESSAGE(!std::filesystem::exists(folder.path() / gone), gone);
  for (const char* kept : {"particles/000000.vtu", "particles/000001.vtu", "mine.tmp"})
    CHECK_MESSAGE(std::filesystem::exists(folder.path() / kept), kept);
}
