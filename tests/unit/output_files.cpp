// A file is written whole or not at all, and stays what it was: a link, a pipe, a device.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

namespace fs = std::filesystem;

TEST_CASE("a file is replaced by its parts, one after the other, and nothing stays beside it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  write_aside(file, "earlier and longer");
  write_aside(file, std::vector<std::string_view>{"one, ", "two"});
  CHECK(read_text(file) == "one, two");
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("what a link points to is written, also where it is not there yet, and the link stays") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "there");
  const fs::path link = folder.path() / "link", chain = folder.path() / "chain";
  fs::create_symlink("there/file", link);
  fs::create_symlink(link, chain);
  for (const char* text : {"first", "second"}) {
    write_aside(chain, text);
    CHECK(fs::is_symlink(chain));
    CHECK(fs::is_symlink(link));
    CHECK(read_text(folder.path() / "there/file") == text);
  }
}

TEST_CASE(
    "the characters that end lines or ring bells are known in a name, and no others are taken for them") {
  for (int byte = 1; byte < 256; ++byte) {  // no name has a zero
    CAPTURE(byte);
    const std::string name = "a" + std::string(1, static_cast<char>(byte)) + "b";
    CHECK(has_control_character("there/" + name + "/file") == (byte < 32 || byte == 127));
  }
  CHECK_FALSE(has_control_character(""));
  CHECK_FALSE(has_control_character("my results/Größe 2 µm"));
}

TEST_CASE("a pipe is written to and stays a pipe") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDWR);  // so that nobody waits for the other
  REQUIRE(reader >= 0);
  write_aside(pipe, "through the pipe");
  CHECK(fs::is_fifo(pipe));
  char text[32] = {};
  if (fs::is_fifo(pipe)) CHECK(read(reader, text, sizeof text - 1) == 16);
  CHECK(std::string(text) == "through the pipe");
  close(reader);
}

TEST_CASE("a device that is full is told with the system's reason") {
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder.path() / "full");
  const auto path = folder.path() / "full";
  CHECK_THROWS_WITH_AS(write_aside(path, "x"),
                       ("cannot write " + path.string() + ": No space left on device").c_str(), FileError);
  CHECK(fs::is_symlink(path));
}

}  // namespace
