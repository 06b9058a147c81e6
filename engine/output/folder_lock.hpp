#pragma once

/// @file One writer a folder: whoever writes a run or a study into a folder holds it as long as it goes on.

#include <filesystem>

#include "engine/output/descriptor.hpp"

namespace mpmfast {

enum class FolderWriter { run, study };

/// Holds a folder for this object until its end, or that of the process. The folder itself is locked, not a
/// file in it: nothing of the lock is left, and no name that is removed or replaced opens it to another.
/// A file system that locks no folders (some of networks) holds nothing; there the lock of history.csv is
/// left.
class FolderLock {
 public:
  /// Of a folder that is there. Throws FileError when another one holds it, which is called a `writer`.
  FolderLock(const std::filesystem::path& folder, FolderWriter writer);

 private:
  Descriptor folder_;
};

}  // namespace mpmfast
