// The searches on a part of a real city, along a flight and a head that turns.
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/lod/build.h"
#include "tests/support/real_scenes.h"
#include "tests/support/search_rig.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::search_scene_test {
namespace {

using test::SearchRig;

// Camera centres, world metres, and focal lengths in pixels.
struct Place {
  Vec3d eye;
  double fx;
};

std::vector<Place> read_places(const std::string& path) {
  std::ifstream file(path);
  std::vector<Place> places;
  for (const auto& camera : nlohmann::json::parse(file)) {
    const auto& p = camera["position"];
    places.push_back(
        {{p[0].get<double>(), p[1].get<double>(), p[2].get<double>()}, camera["fx"].get<double>()});
  }
  return places;
}

// Left and right eyes, two by two, drawn from between them.
std::vector<Place> midpoints(const std::vector<Place>& eyes) {
  std::vector<Place> places;
  for (size_t i = 0; i + 1 < eyes.size(); i += 2)
    places.push_back({0.5 * (eyes[i].eye + eyes[i + 1].eye), std::max(eyes[i].fx, eyes[i + 1].fx)});
  return places;
}

// Some frames in a row, some far apart.
std::vector<Place> sample(const std::vector<Place>& places) {
  if (test::whole_paths()) return places;
  std::vector<Place> some(places.begin(), places.begin() + std::min<size_t>(4, places.size()));
  for (size_t i = 0; i < places.size(); i += places.size() / 3 + 1) some.push_back(places[i]);
  return some;
}

TEST(SearchScene, TheDistrictAlongBothPaths) {
  VOYAGER_NEEDS_SCENES(folder);
  const auto flight = read_places(folder + "/district.flight.cameras.json"),
             head = midpoints(read_places(folder + "/district.headset.cameras.json"));
  Workers workers;
  BakedScene baked = build_tree(test::district(folder), workers, {}, test::city_rule());
  const Vec3d origin{baked.origin[0], baked.origin[1], baked.origin[2]};
  SearchRig rig(std::move(baked.tree));
  for (const auto& places : {flight, head}) {
    ASSERT_GT(places.size(), 10u);
    for (const double tau : {0.0, 3.0, 6.0, 15.0}) {
      uint64_t frames = 0, tested = 0;
      for (const Place& place : sample(places)) {
        ASSERT_TRUE(rig.agree({cut_centre(place.eye, origin), target_size(tau, place.fx)}));
        ++frames;
        tested += rig.temporal.stats().nodes_tested;
      }
      EXPECT_LT(tested, frames * rig.tree.size() / 4);
    }
  }
}

}  // namespace
}  // namespace voyager::search_scene_test
