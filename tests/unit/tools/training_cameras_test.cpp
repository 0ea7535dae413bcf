// The cameras of INRIA, COLMAP and nerfstudio.
#include "tools/training_cameras.h"

#include <gtest/gtest.h>

#include "runtime/base/error.h"
#include "tests/support/test_support.h"
#include "tests/support/training_camera_files.h"
#include "tools/training_cameras/colmap.h"

namespace voyager::training_cameras_test {
namespace {

using namespace test;
using tools::downscaled;
using tools::read_training_cameras;
using tools::usual_downscale;

void expect_near(const TrainingCamera& found, const TrainingCamera& expected) {
  // A position far away is as near as its magnitude lets it be.
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.position[i], expected.position[i],
                1e-12 * std::max(1.0, std::fabs(expected.position[i])));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(found.world_to_view.row[i][k], expected.world_to_view.row[i][k], 1e-12);
  }
  EXPECT_NEAR(found.fx, expected.fx, 1e-12);
  EXPECT_NEAR(found.fy, expected.fy, 1e-12);
  EXPECT_NEAR(found.cx, expected.cx, 1e-12);
  EXPECT_NEAR(found.cy, expected.cy, 1e-12);
  EXPECT_EQ(found.width, expected.width);
  EXPECT_EQ(found.height, expected.height);
}

void expect_three(const std::string& path) {
  SCOPED_TRACE(path);
  const auto found = read_training_cameras(path);
  const auto expected = three_cameras();
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) expect_near(found[i], expected[i].camera());
}

class TrainingCameras : public testing::Test {
 protected:
  // Writes the file and returns its path.
  std::string file(const std::string& name, const std::string& bytes) {
    const std::string path = folder_.file(name);
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_file(path, bytes);
    return path;
  }
  void write_colmap(const std::string& folder, const std::string& ending) {
    const bool text = ending == ".txt";
    const auto all = three_cameras();
    file(folder + "cameras" + ending, text ? colmap_cameras_txt(all) : colmap_cameras_bin(all));
    file(folder + "images" + ending, text ? colmap_images_txt(all) : colmap_images_bin(all));
  }
  void expect_refused(const std::string& path, const std::string& text) {
    try {
      read_training_cameras(path);
      ADD_FAILURE() << "not refused, expected " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  }

  TempFolder folder_;
};

TEST_F(TrainingCameras, AreTheSameInEachFormat) {
  expect_three(file("inria.json", inria_json(three_cameras())));
  expect_three(file("nerfstudio", "\xEF\xBB\xBF\n " + transforms_json(three_cameras())));
  for (const std::string ending : {".txt", ".bin"}) {
    write_colmap("model" + ending + "/", ending);
    expect_three(folder_.file("model" + ending));
    expect_three(folder_.file("model" + ending + "/cameras" + ending));
    expect_three(folder_.file("model" + ending + "/images" + ending));
  }
}

TEST_F(TrainingCameras, OfAFolderAreColmapsBeforeTheOthers) {
  write_colmap("scene/sparse/0/", ".bin");
  file("scene/transforms.json", "{}");
  expect_three(folder_.file("scene"));
  file("other/transforms.json", transforms_json(three_cameras()));
  expect_three(folder_.file("other"));
  file("model/cameras.json", inria_json(three_cameras()));
  expect_three(folder_.file("model"));
  file("none/readme", "");
  expect_refused(folder_.file("none"), "found a folder without cameras, expected COLMAP's");
  file("half/cameras.txt", "");
  expect_refused(folder_.file("half"), "half/images.txt: found no such file, expected it beside");
}

// Content counts, not a name.
TEST_F(TrainingCameras, OfOneKindUnderTheNameOfAnother) {
  file("cameras.txt", colmap_cameras_bin(three_cameras()));
  file("images.txt", colmap_images_txt(three_cameras()));
  expect_three(folder_.file("cameras.txt"));
  expect_three(file("images.bin", transforms_json(three_cameras())));
  // A count of 91 begins with the byte of a bracket.
  const std::vector<Posed> many(91, three_cameras()[1]);
  file("91/cameras.bin", colmap_cameras_bin(many));
  std::string images = colmap_images_bin({many[0]});
  EXPECT_EQ(read_training_cameras(file("91/images.bin", images)).size(), 1u);
  expect_refused(file("photo.png", "\x89PNG"), "expected a cameras.json, a transforms.json, or");
  expect_refused(file("empty.json", ""), "found an empty file");
  expect_refused(file("cameras.json", "x[]"), "found no JSON: its first character is neither");
}

TEST_F(TrainingCameras, OfColmapMayHaveAnyModelWithAFocalLength) {
  const std::string images = "1 1 0 0 0 0 0 0 1 a.jpg\n\n";
  const auto read = [&](const std::string& lens) {
    file("images.txt", images);
    return read_training_cameras(file("cameras.txt", "1 " + lens)).at(0);
  };
  for (const std::string one : {"SIMPLE_PINHOLE 80 60 50 40 30", "RADIAL 80 60 50 40 30 0 0",
                                "SIMPLE_FISHEYE 80 60 50 40 30"})
    expect_near(read(one), Posed{{1, 0, 0, 0}, {}, 50, 50, 40, 30, 80, 60}.camera());
  for (const std::string two : {"FOV 80 60 50 51 40 30 0.1", "EUCM 80 60 50 51 40 30 0 0"})
    expect_near(read(two), Posed{{1, 0, 0, 0}, {}, 50, 51, 40, 30, 80, 60}.camera());
  EXPECT_THROW(read("EQUIRECTANGULAR 80 40 80 40"), Error);
  EXPECT_THROW(read("PINHOLE 80 60 50 40 30"), Error);
}

TEST_F(TrainingCameras, OfTransformsMayBeGivenByAnAngleAndAtTheTop) {
  const std::string frames =
      R"("frames": [{"transform_matrix": [[1,0,0,5],[0,-1,0,6],[0,0,-1,7],[0,0,0,1]]}]})";
  const auto read = [&](const std::string& top) {
    return read_training_cameras(file("transforms.json", "{" + top + frames)).at(0);
  };
  const Posed plain{{1, 0, 0, 0}, {-5, -6, -7}, 50, 50, 40, 30, 80, 60};
  expect_near(read(R"("w": 80.0, "h": 60, "fl_x": 50, )"), plain.camera());
  const std::string angle = fmt::format("{:.17g}", 2 * std::atan(40 / 50.0));
  expect_near(read(R"("w": 80, "h": 60, "camera_angle_x": )" + angle + ", "), plain.camera());
}

// transforms.json has left COLMAP's world by A, and nerfstudio's training by T after A.
TEST_F(TrainingCameras, OfNerfstudioComeToTheWorldItTrainedIn) {
  const std::string applied =
      R"("applied_transform": [[1,0,0,0],[0,0,1,0],[0,-1,0,0]], "applied_scale": 2, )";
  const Posed posed{{1, 0, 0, 0}, {-1, -2, -3}, 50, 50, 40, 30, 80, 60};
  const std::string path = file("n/transforms.json", transforms_json({posed}, applied));
  expect_near(read_training_cameras(path).at(0), posed.camera());
  // T is a quarter turn about z and a step of 10 along it; then all shrinks to a half.
  // T · A: rows of A are e_x, e_z, -e_y.
  file("n/dataparser_transforms.json",
       R"({"transform": [[0,0,-1,0],[1,0,0,0],[0,-1,0,10]], "scale": 1.0})");
  const TrainingCamera moved = read_training_cameras(path).at(0);
  TrainingCamera expected = posed.camera();
  expected.position = {-1, 0.5, 6.5};
  expected.world_to_view = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  expect_near(moved, expected);
  file("n/dataparser_transforms.json", R"({"transform": [[0,0,-1,0],[1,0,0,0],[0,-1,0,10]]})");
  expect_refused(path, "dataparser_transforms.json: found no field scale");
}

TEST_F(TrainingCameras, ShrinkAsTrainersDo) {
  const TrainingCamera large = three_cameras()[0].camera();
  EXPECT_DOUBLE_EQ(usual_downscale(large), 3072 / 1600.0);
  const TrainingCamera small = downscaled(large, usual_downscale(large));
  EXPECT_EQ(small.width, 1600u);
  EXPECT_EQ(small.height, 1200u);
  EXPECT_DOUBLE_EQ(small.fx, large.fx * 1600 / 3072);
  EXPECT_DOUBLE_EQ(small.cy, large.cy * 1600 / 3072);
  EXPECT_EQ(usual_downscale(three_cameras()[1].camera()), 1);
}

TEST_F(TrainingCameras, OfColmapsTextAreRefusedByLineAndWord) {
  const auto refused = [&](const std::string& cameras, const std::string& images,
                           const std::string& text) {
    file("images.txt", images);
    expect_refused(file("cameras.txt", cameras), text);
  };
  const std::string lens = "1 PINHOLE 80 60 50 50 40 30\n", image = "1 1 0 0 0 0 0 0 1 a\n\n";
  refused("# none\n", image, "images.txt: line 1: found an image of camera 1, expected one of");
  refused(lens, "# none\n", "images.txt: found no image, expected at least one");
  refused(lens + lens, image, "cameras.txt: line 2: found camera 1 for the second time");
  refused("1 PINHOLE 80 60 50 50 40", image, "line 1: found the end of the line, expected a num");
  refused("1 PINHOLE 80 60 -5 50 40 30", image, "found focal lengths of -5 and 50, expected fin");
  refused("1 PINHOLE 80 60 nan 50 40 30", image, "found focal lengths of nan and 50");
  refused("1 PINHOLE 80 60 50 50 inf 30", image, "found a principal point at inf, 30");
  refused("1 PINHOLE 0 60 50 50 40 30", image, "found a picture of 0 x 60 pixels");
  refused("1 PINHOLE -1 60 50 50 40 30", image, "found -1, expected a WIDTH");
  refused("1 PINHOLE 9999999 60 50 50 40 30", image, "expected 1 to 1048576 a side");
  refused("1 PANORAMA 80 60 50", image, "found camera model PANORAMA, expected one of COLMAP's");
  refused("1 EQUIRECTANGULAR 80 40 80 40", image, "expected one that has a focal length");
  refused(lens, image + "2 1 0 0 x 0 0 0 1 a\n\n", "line 3: found x, expected a number of an");
  refused(lens, "1 0 0 0 0 0 0 0 1 a\n\n", "found a pose with a zero quaternion");
  refused(lens, "1 1 0 0 0 nan 0 0 1 a\n\n", "found a pose with a zero quaternion, an infinity");
  refused(lens, "1 1 0 0 0 1e300 0 0 1 a\n\n", "found a camera 1e18 or more away");
  refused(lens, std::string(20'000, '1'), "line 1: found more than 16384 bytes");
  EXPECT_THROW(read_training_cameras(folder_.file("nothing.json")), Error);
}

TEST_F(TrainingCameras, OfJsonAreRefusedByFrameAndField) {
  const auto refused = [&](const std::string& json, const std::string& text) {
    expect_refused(file("transforms.json", json), text);
  };
  refused("{", "offset 2: found no JSON there, expected a transforms.json");
  refused("{}", "transforms.json: found no field frames");
  refused(R"({"frames": []})", "frames: found an array of 0, expected an array of at least one");
  refused(R"({"frames": [1]})", "frame 0: found 1, expected an object");
  refused(R"({"frames": [{}]})", "frame 0: found no field w");
  refused(R"({"w": 1, "h": 1, "frames": [{}]})", "frame 0: found no field fl_x");
  refused(R"({"w": 1.5, "frames": [{}]})", "w: found 1.5, expected a whole number from 1");
  const std::string lens = R"({"w": 80, "h": 60, "fl_x": 50, )";
  refused(R"({"w": 80, "h": 60, "fl_x": 0, "frames": [{}]})", "fl_x: found 0, expected a");
  refused(R"({"w": 80, "h": 60, "camera_angle_x": 4, "frames": [{}]})", "half a turn");
  refused(lens + R"("camera_model": "EQUIRECTANGULAR", "frames": [{}]})", "has a focal length");
  const auto frame = [&](const std::string& matrix) {
    return lens + R"("frames": [{"transform_matrix": )" + matrix + "}]}";
  };
  refused(frame("[[1,0,0,0],[0,1,0,0]]"), "expected 3 or 4 rows of 4 finite numbers");
  refused(frame("[[1,0,0],[0,1,0],[0,0,1]]"), "expected 3 or 4 rows of 4 finite numbers");
  refused(frame("[[1,0,0,null],[0,1,0,0],[0,0,1,0]]"), "expected 3 or 4 rows");
  refused(frame("[[2,0,0,0],[0,2,0,0],[0,0,2,0]]"), "expected a rotation");
  refused(frame("[[1,0,0,0],[0,1,0,0],[0,0,-1,0]]"), "expected a rotation");
  refused(frame("[[1,0,0,1e18],[0,1,0,0],[0,0,1,0]]"), "a position below 1e18");
  refused(lens + R"("applied_scale": -1, "frames": [{"transform_matrix": )" +
              "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
          "applied_scale: found -1, expected a number above 0");
  refused("[]", "expected an array of at least one camera");
  refused(R"([{"width": 9}])", "camera 0: found no field height");
}

MemorySource in_memory(const std::string& bytes) {
  return {"memory", std::as_bytes(std::span(bytes))};
}

TEST_F(TrainingCameras, OfColmapsBinaryAreRefusedAtEveryTruncation) {
  const auto all = three_cameras();
  const std::string cameras = colmap_cameras_bin(all), images = colmap_images_bin({all[2], all[0]});
  const tools::ColmapLenses lenses = tools::read_lenses_binary(in_memory(cameras));
  for (size_t size = 0; size < cameras.size(); ++size)
    EXPECT_THROW(tools::read_lenses_binary(in_memory(cameras.substr(0, size))), Error) << size;
  EXPECT_EQ(tools::read_images_binary(in_memory(images), lenses).size(), 2u);
  // One length within the second image's points is as good as another.
  for (size_t size = 0; size < images.size(); size += size < 250 ? 1 : 4999)
    EXPECT_THROW(tools::read_images_binary(in_memory(images.substr(0, size)), lenses), Error)
        << size;
  EXPECT_THROW(tools::read_images_binary(in_memory(images + "x"), lenses), Error);
}

// Whatever a byte becomes: cameras, or a refusal.
TEST_F(TrainingCameras, OfColmapsBinarySurviveEveryFlippedByte) {
  const auto all = three_cameras();
  std::string cameras = colmap_cameras_bin(all), images = colmap_images_bin({all[2], all[0]});
  images.resize(250);
  const tools::ColmapLenses lenses = tools::read_lenses_binary(in_memory(cameras));
  const auto survives = [](std::string& bytes, const auto& read) {
    for (char& byte : bytes)
      for (const char flip : {'\x01', '\x80', '\xFF'}) {
        byte = static_cast<char>(byte ^ flip);
        try {
          read(in_memory(bytes));
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::refused_input);
        }
        byte = static_cast<char>(byte ^ flip);
      }
  };
  survives(cameras, [](const ByteSource& file) { tools::read_lenses_binary(file); });
  survives(images, [&](const ByteSource& file) { tools::read_images_binary(file, lenses); });
}

TEST_F(TrainingCameras, OfColmapsBinaryClaimNoMoreThanTheirBytes) {
  const auto all = three_cameras();
  const std::string path = file("cameras.bin", colmap_cameras_bin(all));
  std::string images = colmap_images_bin({all[0]});
  const auto claim = [&](size_t at, uint64_t count, const std::string& text) {
    std::string bytes = images;
    std::memcpy(bytes.data() + at, &count, sizeof count);
    file("images.bin", bytes);
    expect_refused(path, text);
  };
  claim(0, uint64_t{1} << 40, "offset 0: found images: 1099511627776, expected at most the 1 that");
  claim(images.size() - 8, UINT64_MAX / 24 + 2, "found points in an image: 7686143");
  std::string cameras = colmap_cameras_bin(all);
  const int32_t model = 99;
  std::memcpy(cameras.data() + 12, &model, sizeof model);
  file("cameras.bin", cameras);
  expect_refused(path, "offset 8: found camera model 99, expected a number from 0 to 17");
}

}  // namespace
}  // namespace voyager::training_cameras_test
