#include "tools/view/sample.h"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/base/error.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/test_support.h"
#include "tools/view/sparse_ply.h"

namespace voyager::view_sample_test {
namespace {

using namespace voyager::view;

constexpr size_t kCount = 1000;

// Gaussian i stands at x = i.
std::vector<std::byte> ply_of(size_t count) {
  GaussianCloud cloud;
  for (size_t i = 0; i < count; ++i) {
    cloud.position.insert(cloud.position.end(), {static_cast<float>(i), 2, 3});
    cloud.log_scale.insert(cloud.log_scale.end(), {-1, -2, -3});
    cloud.rotation.insert(cloud.rotation.end(), {1, 0, 0, 0});
    cloud.opacity.push_back(0.5f);
    cloud.sh.insert(cloud.sh.end(), {0.1f, 0.2f, 0.3f});
  }
  return as_ply(cloud);
}

const auto kNothing = [] {};

TEST(ViewSample, IsSpreadOverTheFile) {
  const auto bytes = ply_of(kCount);
  const auto source = std::make_shared<MemorySource>("scene.ply", bytes);
  const GaussianCloud sample = read_sample(source, 100, kNothing);
  ASSERT_EQ(sample.size(), 100u);
  for (size_t i = 0; i < sample.size(); ++i)
    EXPECT_EQ(sample.position[3 * i], static_cast<float>(10 * i));
}

TEST(ViewSample, OfASmallSceneIsTheScene) {
  const auto bytes = ply_of(kCount);
  const auto source = std::make_shared<MemorySource>("scene.ply", bytes);
  EXPECT_EQ(as_ply(read_sample(source, kCount, kNothing)), bytes);
}

// Whatever parts of it are read, it is a .ply of every seventh row.
TEST(ViewSample, ASparsePlyIsAPly) {
  const auto bytes = ply_of(kCount);
  const auto source = std::make_shared<MemorySource>("scene.ply", bytes);
  const auto sparse = sparse_ply(source, 7);
  ASSERT_NE(sparse, nullptr);
  std::vector<std::byte> whole(sparse->size()), pieces(sparse->size());
  sparse->read(0, whole);
  for (size_t at = 0; at < pieces.size(); at += 37)
    sparse->read(at, std::span(pieces).subspan(at, std::min<size_t>(37, pieces.size() - at)));
  EXPECT_EQ(whole, pieces);
  const GaussianCloud cloud = import_gaussians(sparse);
  ASSERT_EQ(cloud.size(), (kCount + 6) / 7);
  EXPECT_EQ(cloud.position[3 * 5], 35.0f);
}

// A truncated file is refused as a whole one is: by its importer.
TEST(ViewSample, WhatIsNoPlainPlyIsLeftToItsImporter) {
  auto bytes = ply_of(kCount);
  bytes.resize(bytes.size() - 1);
  const auto truncated = std::make_shared<MemorySource>("scene.ply", bytes);
  EXPECT_EQ(sparse_ply(truncated, 7), nullptr);
  EXPECT_THROW(read_sample(truncated, 100, kNothing), Error);
  const std::vector<std::byte> other(100);
  EXPECT_EQ(sparse_ply(std::make_shared<MemorySource>("scene.spz", other), 7), nullptr);
}

TEST(ViewSample, EndsWhereItIsToldTo) {
  const auto bytes = ply_of(kCount);
  const auto source = std::make_shared<MemorySource>("scene.ply", bytes);
  EXPECT_THROW(read_sample(source, 100, [] { throw 3; }), int);
}

}  // namespace
}  // namespace voyager::view_sample_test
