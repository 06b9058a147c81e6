// A checkpoint.h5 with a checksum that fits, and numbers that are none of its run: resume says so.

#include <hdf5.h>
#include <sys/stat.h>

#include "engine/output/checkpoint_file.hpp"
#include "engine/run/run_counters.hpp"
#include "tests/forged.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;
namespace fs = std::filesystem;

const char* const kDisks = R"(
space: plane_strain
grid: {size: [6 mm, 4 mm], cell: 0.5 mm}
time: {end: 20 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [2 mm, 2 mm], radius: 0.9 mm}, material: m, velocity: [60 m/s, 5 m/s]}
  - {name: b, disk: {centre: [3.7 mm, 2.2 mm], radius: 0.9 mm}, material: m, velocity: [-60 m/s, 0 m/s]}
contact: {law: coulomb, friction: 0.3}
output: {frames: 2, history: 5, picture: none}
)";

/// A stopped run, and all columns of its checkpoint.
class Stopped {
 public:
  Stopped() : scene_(scene_from(kDisks)) {
    RunOptions options;
    options.folder = folder_ / "run";
    options.max_steps = 12;
    run_scene(scene_, options);
    CheckpointReader file(folder_ / "run" / "checkpoint.h5");
    RunOrigin origin;
    Step<2> step(scene_);
    RunCounters<2> counters(scene_);
    counters.last_sums = step.sums();
    origin.visit(file);
    step.visit(file);
    counters.visit(file);
    origin.visit(good_);
    step.visit(good_);
    counters.visit(good_);
  }
  const Forged& good() const { return good_; }
  fs::path file() const { return folder_ / "run" / "checkpoint.h5"; }
  /// What resume says of the run with this checkpoint.
  std::string resume(const Forged& state) const {
    CheckpointWriter file(folder_ / "run" / "checkpoint.h5");
    state.write(file);
    file.keep();
    return resume();
  }
  std::string resume() const {
    RunOptions options;
    options.folder = folder_ / "run";
    options.max_steps = 14;
    try {
      const auto summary = resume_run(options);
      return summary ? summary->status : "nothing to do";
    } catch (const FileError& error) {
      return error.what();
    }
  }

 private:
  Folder folder_;
  Scene scene_;
  Forged good_;
};

TEST_CASE("a checkpoint whose counters or particles are none of its run is refused") {
  const Stopped run;
  const auto told = [&](const std::string& name, double value) {
    Forged state = run.good();
    REQUIRE(state.has(name));
    state.set(name, 0, value);
    return run.resume(state);
  };
  const auto holds = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
  };
  CHECK(holds(told("run/spacing_body", 99), "run/spacing_body does not fit it"));
  CHECK(holds(told("run/wall_seconds", 1e300), "run/wall_seconds does not fit it"));
  CHECK(holds(told("run/wall_seconds", -1), "run/wall_seconds does not fit it"));
  CHECK(holds(told("run/frame_times", HUGE_VAL), "run/frame_times does not fit it"));
  CHECK(holds(told("origin/end", HUGE_VAL), "has no end"));
  CHECK(holds(told("particles/body", 65535), "is of body 65535"));
  CHECK(holds(told("tiling/bodies", 0), "its tiles do not fit the particles"));
  for (const char* name : {"particles/mass", "step/time", "run/dt", "sums/friction_work"})
    CHECK(holds(told(name, std::nan("")), "holds what is no number"));
  CHECK(run.resume(run.good()) == "finished");
}

/// In place of a column, one that claims so many entries and holds none.
void claim(const fs::path& path, const char* name, hsize_t entries) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &entries, nullptr);
  const hid_t data = H5Dcreate2(file, name, H5T_NATIVE_UINT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dclose(data);
  H5Sclose(space);
  H5Fclose(file);
}

TEST_CASE("a column that claims more than the file holds is refused before it takes the memory") {
  const Folder folder;
  const fs::path path = folder / "data.h5";
  std::vector<std::uint64_t> values(10, 7);
  {
    Hdf5File file = Hdf5File::create(path, 512);
    file.write("values", NumberKind::whole64, values.data(), values.size());
    file.close();
  }
  CHECK(Hdf5File::open(path).length("values") == 10);
  for (const hsize_t entries : {hsize_t{1000}, hsize_t{1} << 40, hsize_t{1} << 60}) {
    claim(path, "values", entries);
    CHECK_THROWS_AS(Hdf5File::open(path).length("values"), FileError);
  }
}

TEST_CASE("a checkpoint that is a pipe or a device is refused at once") {
  const Stopped run;
  fs::remove(run.file());
  REQUIRE(mkfifo(run.file().c_str(), 0600) == 0);
  CHECK(run.resume().find("is not a file but") != std::string::npos);
  fs::remove(run.file());
  fs::create_symlink("/dev/zero", run.file());
  CHECK(run.resume().find("is not a file but") != std::string::npos);
}

}  // namespace
}  // namespace mpmfast
