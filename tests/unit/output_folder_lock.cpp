#include <doctest/doctest.h>

#include "engine/errors.hpp"
#include "engine/output/folder_lock.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace fs = std::filesystem;

TEST_CASE("a folder has one writer at a time, by whatever name it is called") {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run", link = folder.path() / "link";
  CHECK_THROWS_AS(FolderLock(run, FolderWriter::run), FileError);
  fs::create_directory(run);
  fs::create_directory_symlink(run, link);
  {
    const FolderLock lock(run, FolderWriter::run);
    for (const fs::path& name : {run, run / "", run / "." / "", link, link / ".." / "run"})
      CHECK_THROWS_AS(FolderLock(name, FolderWriter::run), FileError);
    CHECK(fs::is_empty(run));  // nothing that others could take away
  }
  const FolderLock lock(link, FolderWriter::study);
  std::string why;
  try {
    FolderLock(run, FolderWriter::study);
  } catch (const FileError& error) {
    why = error.what();
  }
  CHECK(why == run.string() + " belongs to a study that goes on now");
}

TEST_CASE("a run that prepared a folder holds it, with force too, and touches nothing of another's") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  const fs::path run = folder.path() / "run";
  {
    const FolderLock lock = prepare_folder(run, scene, false);
    HistoryFile history(run, scene);
    const std::string before = read_text(run / "history.csv");
    for (const bool force : {false, true}) CHECK_THROWS_AS(prepare_folder(run, scene, force), FileError);
    CHECK(read_text(run / "history.csv") == before);
    CHECK_NOTHROW(history.append({}));
  }
  {
    HistoryFile history(run, scene);  // where folders cannot be locked, the history still is
    CHECK_THROWS_AS(prepare_folder(run, scene, true), FileError);
    CHECK_NOTHROW(history.append({}));
  }
  CHECK_NOTHROW(prepare_folder(run, scene, true));
  CHECK_THROWS_AS(prepare_folder(folder.path() / "a\nb", scene, true), FileError);
  CHECK_FALSE(fs::exists(folder.path() / "a\nb"));
}
