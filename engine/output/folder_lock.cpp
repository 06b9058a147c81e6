#include "engine/output/folder_lock.hpp"

#include "engine/errors.hpp"

namespace mpmfast {

FolderLock::FolderLock(const std::filesystem::path& folder, FolderWriter writer)
    : folder_(Descriptor::open_folder(folder)) {
  if (!folder_.claim())
    throw FileError(folder.string() + (writer == FolderWriter::run ? " belongs to a run that goes on now"
                                                                   : " belongs to a study that goes on now"));
  // Between opening and locking another one may have removed the folder, and made it again.
  if (!folder_.is_at(folder)) throw FileError(folder.string() + " was removed just now");
}

}  // namespace mpmfast
