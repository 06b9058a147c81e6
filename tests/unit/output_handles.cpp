// Open files and objects of HDF5: who holds one closes it, once, and who gave it away closes nothing.

#include <doctest/doctest.h>
#include <fcntl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "engine/output/descriptor.hpp"
#include "engine/output/hdf5_file.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

std::array<int, 2> closed{};  ///< how often, of the objects 0 and 1

int count_closing(std::int64_t id) {
  ++closed[static_cast<std::size_t>(id)];
  return 0;
}

TEST_CASE("a descriptor that was moved from closes no file, neither its own nor the standard input") {
  // Where the program has no standard input, a file takes its number.
  const Descriptor input = fcntl(0, F_GETFD) < 0 ? Descriptor::open("/dev/null") : Descriptor();
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  std::optional<Descriptor> first(Descriptor::create(path));
  REQUIRE(fcntl(0, F_GETFD) >= 0);
  const Descriptor second = std::move(*first);
  first.reset();
  CHECK(fcntl(0, F_GETFD) >= 0);
  second.write_at("what was written", 0, path);
  CHECK(read_text(path) == "what was written");
}

TEST_CASE("an object of HDF5 is closed once, by the last handle that had it, whatever its number") {
  closed = {};
  {
    Hdf5Handle first(0, count_closing), other(1, count_closing);
    CHECK(first.valid());
    Hdf5Handle second = std::move(first);
    CHECK_FALSE(first.valid());
    CHECK(first.close());
    CHECK(closed == std::array<int, 2>{0, 0});
    CHECK(second.close());
    CHECK(closed == std::array<int, 2>{1, 0});
    CHECK(second.close());
  }
  CHECK(closed == std::array<int, 2>{1, 1});
}

}  // namespace
