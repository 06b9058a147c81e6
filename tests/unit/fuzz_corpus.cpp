// What the fuzzers begin with, and what they once found, through the same entries: without clang.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/entries.hpp"
#include "tests/source_folder.hpp"

namespace mpmfast {
namespace {

namespace fs = std::filesystem;

/// Calls the entry with every file of a folder; returns how many there are.
int replay(const fs::path& folder, void (*entry)(fuzz::Bytes)) {
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(test::source_folder() / folder))
    if (item.is_regular_file()) files.push_back(item.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream),
                                           std::istreambuf_iterator<char>()};
    CAPTURE(file.string());
    CHECK_NOTHROW(entry(bytes));
  }
  return static_cast<int>(files.size());
}

TEST_CASE("the scene reader takes the fuzzers' corpus and every scene of the repository") {
  CHECK(replay("tests/fuzz/corpus/scene", fuzz::read_scene_bytes) >= 3);
  CHECK(replay("tests/cli/broken", fuzz::read_scene_bytes) > 30);
  CHECK(replay("configs/starters", fuzz::read_scene_bytes) >= 3);
  CHECK(replay("configs", fuzz::read_scene_bytes) > 10);
}

TEST_CASE("the study reader takes the fuzzers' corpus and every study of the repository") {
  CHECK(replay("tests/fuzz/corpus/study", fuzz::read_study_bytes) >= 2);
  CHECK(replay("configs/studies", fuzz::read_study_bytes) > 5);
  CHECK(replay("configs/starters/study", fuzz::read_study_bytes) == 1);
}

TEST_CASE("the readers of pictures and surfaces take the fuzzers' corpus, and each other's") {
  CHECK(replay("tests/fuzz/corpus/bitmap", fuzz::read_bitmap_bytes) >= 4);
  CHECK(replay("tests/fuzz/corpus/stl", fuzz::read_stl_bytes) >= 5);
  CHECK(replay("tests/fuzz/corpus/stl", fuzz::read_bitmap_bytes) >= 5);
  CHECK(replay("tests/fuzz/corpus/bitmap", fuzz::read_stl_bytes) >= 4);
}

TEST_CASE("the readers of run.json and of checkpoints take the fuzzers' corpus, and each other's") {
  CHECK(replay("tests/fuzz/corpus/json", fuzz::read_json_bytes) >= 4);
  CHECK(replay("tests/fuzz/corpus/checkpoint", fuzz::read_checkpoint_bytes) >= 6);
  CHECK(replay("tests/fuzz/corpus/checkpoint", fuzz::read_json_bytes) >= 6);
  CHECK(replay("tests/fuzz/corpus/json", fuzz::read_checkpoint_bytes) >= 4);
}

TEST_CASE("the reader of tables takes the fuzzers' corpus, and those of other readers") {
  CHECK(replay("tests/fuzz/corpus/table", fuzz::read_table_bytes) == 8);
  CHECK(replay("tests/fuzz/corpus/study", fuzz::read_table_bytes) >= 2);
  CHECK(replay("tests/fuzz/corpus/bitmap", fuzz::read_table_bytes) >= 4);
}

}  // namespace
}  // namespace mpmfast
