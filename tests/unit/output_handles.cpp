// Open files and objects of HDF5: who holds one closes it, once, and who gave it away closes nothing.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "engine/errors.hpp"
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

TEST_CASE("a program without a standard input opens and makes files, and looks into folders, as any other") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  const int input = dup(0);
  const auto with = [&](const auto& open, const auto& use) {
    close(0);
    try {
      const Descriptor file = open();
      CHECK(fcntl(0, F_GETFD) >= 0);  // its number
      use(file);
    } catch (const FileError& error) {
      FAIL_CHECK(error.what());
    }
    CHECK(fcntl(0, F_GETFD) < 0);
  };
  const auto writes = [&](const char* text) {
    return [&, text](const Descriptor& file) { file.write_at(text, 0, path); };
  };
  with([&] { return Descriptor::create(path); }, writes("one"));
  CHECK(read_text(path) == "one");
  with([&] { return Descriptor::open_or_create(path); }, writes("two"));
  CHECK(read_text(path) == "two");
  with([&] { return Descriptor::open(path, true); }, writes("six"));
  CHECK(read_text(path) == "six");
  with([&] { return Descriptor::open(path); },
       [&](const Descriptor& file) {
         std::array<char, 4> text{};
         CHECK(file.read_at(text.data(), text.size(), 0, path) == 3);
         CHECK(std::string(text.data()) == "six");
       });
  with([&] { return Descriptor::open_folder(folder.path()); },
       [&](const Descriptor& there) { CHECK(there.is_at(folder.path())); });
  if (input >= 0) {
    REQUIRE(dup2(input, 0) == 0);
    close(input);
  }
}

TEST_CASE("a file ends where it ends, whatever call of the system was interrupted before") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  const Descriptor file = Descriptor::create(path);
  file.write_at("seven", 0, path);
  file.write_at("ty", 5, path);
  std::string text(9, '-');
  errno = EINTR;
  CHECK(file.read_at(text.data(), 9, 0, path) == 7);
  CHECK(text == "seventy--");
  CHECK(file.read_at(text.data(), 9, 7, path) == 0);
  CHECK(file.read_at(text.data(), 2, 3, path) == 2);
  CHECK(text == "enventy--");
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
