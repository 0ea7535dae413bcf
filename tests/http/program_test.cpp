// `voyager` with URLs, through libvoyager.so and the module, as a user runs it.
#include "tests/command_line/program.h"
#include "tests/abi/elf.h"
#include "tests/http/http_test.h"
#include "tests/http/nginx.h"

namespace voyager::program_test {
namespace {

using namespace test;

class Program : public testing::Test {
 protected:
  void SetUp() override {
    VOYAGER_NEEDS_NGINX();
    const std::string city = nginx_.folder("files/city.");
    ASSERT_EQ(failure_of({"voyager synth city --gaussians 10000 -o " + city + "ply",
                          "voyager bake " + city + "ply -o " + city + "voy"}),
              "");
    ASSERT_EQ(nginx_.start(), "");
  }
  std::string local(const std::string& name) const { return nginx_.folder("files/" + name); }

  Nginx nginx_;
};

TEST_F(Program, InfoOfAUrlIsTheFilesBesideItsName) {
  const Outcome near = run("voyager info " + local("city.voy"));
  const Outcome far = run("voyager info " + nginx_.url("city.voy"));
  EXPECT_EQ(far.exit_code, 0) << far.output;
  EXPECT_EQ(far.output.substr(far.output.find('\n')), near.output.substr(near.output.find('\n')));
  EXPECT_EQ(far.output.find(nginx_.url("city.voy") + ": compact scene"), 0u) << far.output;
}

TEST_F(Program, AUrlIsRenderedBakedAndExportedAsTheFileIs) {
  const std::string cameras = " --cameras " + local("city.cameras.json") + " --size 64x48 -o ";
  ASSERT_EQ(failure_of({"voyager render " + local("city.voy") + cameras + local("near.pfm"),
                        "voyager render " + nginx_.url("city.voy") + cameras + local("far.pfm"),
                        "voyager export " + local("city.voy") + " -o " + local("near.hier"),
                        "voyager export " + nginx_.url("city.voy") + " -o " + local("far.hier"),
                        "voyager bake " + nginx_.url("city.ply") + " -o " + local("far.voy")}),
            "");
  EXPECT_EQ(file_bytes(local("far.pfm")), file_bytes(local("near.pfm")));
  EXPECT_EQ(file_bytes(local("far.hier")), file_bytes(local("near.hier")));
  EXPECT_EQ(file_bytes(local("far.voy")), file_bytes(local("city.voy")));
}

TEST_F(Program, AMissingFileIsRefusedInputAndNoSecretIsShown) {
  std::string url = nginx_.url("none.voy?key=hidden");
  url.insert(7, "anna:secret@");
  const Outcome outcome = run("voyager info '" + url + "'");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_NE(outcome.output.find("found status 404"), std::string::npos) << outcome.output;
  const Outcome found = run("voyager info --json 'http://anna:secret@" +
                            nginx_.url("city.voy?key=hidden").substr(7) + "'");
  EXPECT_EQ(found.exit_code, 0) << found.output;
  for (const char* secret : {"secret", "hidden"}) {
    EXPECT_EQ(outcome.output.find(secret), std::string::npos) << outcome.output;
    EXPECT_EQ(found.output.find(secret), std::string::npos) << found.output;
  }
}

TEST_F(Program, AServerThatIsNotThereIsTheMachine) {
  const std::string url = nginx_.url("city.voy");
  nginx_.stop();
  const Outcome outcome = run("voyager info " + url);
  EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
  EXPECT_NE(outcome.output.find(url + ": "), std::string::npos) << outcome.output;
}

// Nothing but the module needs libcurl, and without it URLs alone are refused.
TEST(Module, IsAllThatNeedsLibcurl) {
  const std::string libraries = VOYAGER_BIN_DIR "/../lib/";
  const auto needs_curl = [](const std::string& path) {
    for (const std::string& library : ElfFile(path).needed())
      if (library.rfind("libcurl", 0) == 0) return true;
    return false;
  };
  EXPECT_TRUE(needs_curl(libraries + "libvoyager_http.so"));
  EXPECT_FALSE(needs_curl(libraries + "libvoyager.so"));
  EXPECT_FALSE(needs_curl(VOYAGER_BIN_DIR "/voyager"));
  EXPECT_EQ(ElfFile(libraries + "libvoyager_http.so").exports(),
            std::vector<std::string>{"voyager_http_module"});
}

TEST(Module, WhereItIsMissingIsNamed) {
  const TempFolder folder;
  namespace fs = std::filesystem;
  fs::create_directories(folder.file("bin"));
  fs::create_directories(folder.file("lib"));
  fs::copy_file(VOYAGER_BIN_DIR "/voyager", folder.file("bin/voyager"));
  for (const auto& entry : fs::directory_iterator(VOYAGER_BIN_DIR "/../lib")) {
    const std::string name = entry.path().filename();
    if (name.rfind("libvoyager.so", 0) == 0)
      fs::copy(entry.path(), folder.file("lib/" + name), fs::copy_options::copy_symlinks);
  }
  const std::string said = folder.file("said");
  const int status =
      std::system(("LD_LIBRARY_PATH=" + folder.file("lib") + " " + folder.file("bin/voyager") +
                   " info http://127.0.0.1:1/x.voy >" + said + " 2>&1")
                      .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1) << file_bytes(said);
  EXPECT_NE(file_bytes(said).find("libvoyager_http.so: not found in "), std::string::npos)
      << file_bytes(said);
}

}  // namespace
}  // namespace voyager::program_test
