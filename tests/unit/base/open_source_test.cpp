// Which source a path gets, and what of a path may be shown.
#include "runtime/base/open_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/base/error.h"
#include "runtime/base/url.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::open_source_test {
namespace {

TEST(Url, IsToldByItsScheme) {
  for (const char* url : {"http://h/x", "https://h", "HTTP://h/x", "hTTps://"})
    EXPECT_TRUE(is_url(url)) << url;
  for (const char* path : {"", "http:/h/x", "http", "./http://h", "ftp://h/x", "city.voy"})
    EXPECT_FALSE(is_url(path)) << path;
}

TEST(Url, IsShownWithoutItsSecrets) {
  const std::pair<const char*, const char*> cases[] = {
      {"http://h/a/city.voy", "http://h/a/city.voy"},
      {"https://anna:secret@h:81/city.voy", "https://h:81/city.voy"},
      {"https://token@h", "https://h"},
      {"http://a@secret@h/x", "http://h/x"},
      {"https://h/x.voy?key=secret", "https://h/x.voy"},
      {"https://h?secret", "https://h"},
      {"http://h/x#secret", "http://h/x"},
      {"http://u:secret@[::1]:8080/x@1/y", "http://[::1]:8080/x@1/y"},
      {"HTTP://u:secret@h/x", "HTTP://h/x"},
      {"http://u:sec/ret@h/x", "http://(malformed)"},
      {"./a?b#c@d", "./a?b#c@d"}};
  for (const auto& [url, shown] : cases) EXPECT_EQ(shown_path(url), shown) << url;
}

TEST(OpenSource, TakesAnythingElseForAFile) {
  for (const char* path : {"no/such/file.voy", "ftp://h/x.voy", "http:/h/x.voy"}) {
    try {
      open_source(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_not_found) << error.what();
    }
  }
}

// A streamed scene's folder may hold a meta.json for another program.
TEST(OpenSource, OfAFolderOpensTheFileOfItsScene) {
  const test::TempFolder folder;
  const std::string path = folder.file("");
  EXPECT_EQ(scene_file(path), path);
  EXPECT_NE(test::refusal_of([&] { open_source(path); }).find("found a directory"),
            std::string::npos);
  for (const char* name : {"tileset.json", "meta.json", "lod-meta.json"}) {
    std::ofstream(folder.file(name)) << name;
    EXPECT_EQ(open_source(path)->name(), folder.file(name));
    EXPECT_EQ(scene_file(folder.file(name)), folder.file(name));
  }
  EXPECT_EQ(scene_file("http://localhost/"), "http://localhost/");
}

}  // namespace
}  // namespace voyager::open_source_test
