#pragma once
// A folder of files that the program makes and will remove again, at a place that a user named.
// What it did not make there stays: a file in the folder says whose it is, before anything else is
// written; that file is locked while a process works in the folder; and only files of known names
// are removed, then the folder if it is empty.
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file_descriptor.h"

namespace voyager {

// The file that says whose a folder is: a line with the kind, the key, an empty line, then notes,
// each with its checksum.
inline constexpr const char* kFolderMark = "made-by-voyager";

struct FolderKind {
  const char* of;      // "a bake"
  const char* advice;  // what to do where the folder is another's: "give another --work, or ..."
  // Whether the program writes a file of that name there, where it has left these notes.
  bool (*is_own)(std::string_view name, const std::vector<std::string>& notes);
};

// Another process is at work in the folder.
class FolderTaken : public Error {
 public:
  explicit FolderTaken(const std::string& message) : Error(ErrorCode::io, message) {}
};

// A file itself, and no link to one: nothing else is ever removed.
bool is_plain_file(const std::string& path);

class OwnedFolder {
 public:
  enum class OtherKey { refused, emptied };

  // Made if absent, with the folders above it, and marked if it was absent or empty. `alone` keeps
  // other processes out while the object lives; else others that are not alone may be in, too. What
  // is there under another key is refused, or removed to start anew. Throws Error(refused_input),
  // with nothing touched, for a folder with files and no mark, or of another kind or key, naming
  // the first line that differs; FolderTaken where another process is in the folder.
  OwnedFolder(const std::string& path, const FolderKind& kind, const std::string& key, bool alone,
              OtherKey other = OtherKey::refused);

  const std::string& path() const { return path_; }
  bool marked() const { return marked_; }  // by this object: it was absent or empty

  // A line for is_own(), also of whoever removes the folder after a kill.
  void add_note(const std::string& note);
  // The names of the files that the program has written, but for the mark.
  std::vector<std::string> own_files() const;
  // Removes the files of own_files() and the mark; then the folder, and those above it that were
  // made with it, as far as they are empty. Folders that were there before stay. Returns the names
  // of what is left in the folder. The object then holds nothing.
  std::vector<std::string> remove();

  // The same for a folder whose process was killed. If the folder is empty then, it is removed
  // even if it was there before. A folder that is not marked as of this kind stays as it is; so
  // does one in which a process works.
  static void remove_abandoned(const std::string& path, const FolderKind& kind);

 private:
  OwnedFolder(const std::string& path, const FolderKind& kind);
  void take(const std::string& text, bool alone, OtherKey other);
  void make();
  void remove_made(unsigned folders) const;
  bool mark(const std::string& text, bool alone);  // false: another process was faster
  bool open_mark();                                // false: there is none
  enum class Lock { held, refused, stale };
  Lock lock(bool alone);
  // Whether the folder's mark is still the one that is held: somebody may have moved the folder
  // away, and another process made it anew.
  bool is_here() const;
  std::string read_mark() const;
  std::vector<std::string> names() const;
  // False where another process has made the folder its own, or removed it, since it was looked at.
  // Throws Error(refused_input) where there are files and no mark.
  bool is_empty() const;
  std::string mark_path() const { return path_ + "/" + kFolderMark; }

  std::string path_;
  const FolderKind& kind_;
  FileDescriptor mark_;
  unsigned made_ = 0;  // folders, of which path_ is the deepest
  bool marked_ = false;
};

}  // namespace voyager
