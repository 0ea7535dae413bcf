#include "tools/joined_inputs.h"

#include <gtest/gtest.h>

#include "runtime/scene/append.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/transform.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::joined_inputs_test {
namespace {

using test::Bytes;
using Sources = std::vector<std::shared_ptr<const ByteSource>>;

const Affine kTurned{{{{0, 0, 2}, {0, 2, 0}, {-2, 0, 0}}}, {10, 0, -3}};
const Affine kMirrored{{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 7, 0}};

// Of bytes that outlive the sources.
Sources sources_of(const std::vector<Bytes>& files) {
  Sources sources;
  for (size_t i = 0; i < files.size(); ++i)
    sources.push_back(std::make_shared<MemorySource>("input " + std::to_string(i), files[i]));
  return sources;
}

GaussianCloud moved(GaussianCloud cloud, const Affine& place) {
  CloudTransform(place, "by hand").apply(cloud, {});
  return cloud;
}

Bytes glb_of(const GaussianCloud& cloud) {
  test::PlacedBytesSink sink;
  const auto writer = write_glb(sink, cloud.size(), cloud.sh_degree);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

// The two have another SH degree, and more than one block each.
TEST(JoinedInputs, AreWhatMovingAndAppendingMakesOfThem) {
  const std::vector<Bytes> files = {test::ply_of(test::random_cloud(20000, 1, 1)),
                                    test::ply_of(test::random_cloud(17000, 2, 3))};
  GaussianCloud expected = moved(test::import_bytes(files[0]), kTurned);
  append(expected, moved(test::import_bytes(files[1]), kMirrored), "second");
  const auto reader = tools::open_joined(sources_of(files), {{}, {kTurned, kMirrored}});
  EXPECT_EQ(reader->count(), 37000u);
  EXPECT_EQ(reader->sh_degree(), 3);
  EXPECT_EQ(test::ply_of(import_gaussians(*reader)), test::ply_of(expected));
}

// A glTF is several inputs in one already.
TEST(JoinedInputs, MayBeJoinedThemselves) {
  const std::vector<Bytes> files = {glb_of(test::random_cloud(30, 1, 1)),
                                    glb_of(test::random_cloud(20, 2, 0))};
  GaussianCloud expected = import_gaussians(sources_of(files)[0]);
  append(expected, import_gaussians(sources_of(files)[1]), "second");
  for (const tools::Placement& placement : {tools::Placement{}, tools::Placement{{"-y"}, {}}})
    EXPECT_EQ(test::ply_of(import_gaussians(*tools::open_joined(sources_of(files), placement))),
              test::ply_of(expected));
}

TEST(JoinedInputs, MustAgreeWhereTheyAreNotMoved) {
  GaussianCloud far = test::random_cloud(5, 1, 0);
  far.origin = {1e6 * 1.024, 0, 0};
  const std::vector<Bytes> files = {test::ply_of(test::random_cloud(4, 2, 0)),
                                    test::ply_of(far, true)};
  const std::string refusal = test::refusal_of([&] { tools::open_joined(sources_of(files), {}); });
  EXPECT_NE(refusal.find("input 1: origin: found"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("--transform"), std::string::npos) << refusal;
  EXPECT_EQ(tools::open_joined(sources_of(files), {{"-y"}, {}})->count(), 9u);
}

TEST(JoinedInputs, OfDifferentFiltersAreRefused) {
  test::BytesSink sink;
  const auto writer = write_ply(sink, 3, 0, false, compensated_scale(kLowPass));
  writer->append(test::random_cloud(3, 3, 0));
  writer->finish();
  const std::vector<Bytes> files = {test::ply_of(test::random_cloud(4, 2, 0)), sink.bytes};
  const std::string refusal = test::refusal_of([&] { tools::open_joined(sources_of(files), {}); });
  EXPECT_NE(refusal.find("input 1: trained with: found"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find(".glb"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace voyager::joined_inputs_test
