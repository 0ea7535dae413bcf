// The exhaustive search against METHOD §3 written as a recursion, and the
// invariant that makes a cut a cut.
#include "runtime/select/cut.h"

#include <limits>

#include "tests/support/tree_clouds.h"

namespace voyager::cut_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// METHOD §3, word by word, so that no compiler may fuse a product with a sum.
__attribute__((noinline)) float size_of(const LodTree& tree, uint32_t n, const Vec3f& c) {
  const NodeRecord& r = tree.records[n];
  volatile float product[3];
  for (int i = 0; i < 3; ++i) {
    const float d = c[i] - std::min(std::max(c[i], r.box_min[i]), r.box_max[i]);
    product[i] = d * d;
  }
  volatile float xy = product[0] + product[1];
  const float squared = xy + product[2];
  return squared == 0.0f || r.extent == kInfinity ? kInfinity : r.extent / std::sqrt(squared);
}

bool is_missing(std::span<const MissingNodes> missing, uint32_t n) {
  for (const MissingNodes& m : missing)
    if (n >= m.first && n - m.first < m.count) return true;
  return false;
}

struct Expected {
  std::vector<uint32_t> cut;
  uint32_t needed_missing = kNoNode;
};

void descend(const LodTree& tree, std::span<const MissingNodes> missing, const CutQuery& query,
             uint32_t n, Expected& expected) {
  if (is_missing(missing, n)) {
    expected.needed_missing = std::min(expected.needed_missing, n);
    return;
  }
  if (size_of(tree, n, query.centre) < query.target_size || tree.is_leaf(n)) {
    expected.cut.push_back(n);
    return;
  }
  for (uint32_t i = 0; i < tree.records[n].child_count; ++i)
    descend(tree, missing, query, tree.first_child[n] + i, expected);
}

Expected recursive_cut(const LodTree& tree, std::span<const MissingNodes> missing,
                       const CutQuery& query) {
  Expected expected;
  if (tree.size() > 0) descend(tree, missing, query, 0, expected);
  std::sort(expected.cut.begin(), expected.cut.end());
  return expected;
}

void expect_every_path_met_once(const LodTree& tree, const std::pmr::vector<uint32_t>& cut) {
  std::vector<uint32_t> met(tree.size(), 0);  // cut nodes on the path from the root
  for (const uint32_t n : cut) ++met[n];
  for (uint32_t n = 0; n < tree.size(); ++n) {
    if (n > 0) met[n] += met[tree.parent[n]];
    if (tree.is_leaf(n)) {
      ASSERT_EQ(met[n], 1u) << "leaf " << n;
    }
  }
}

std::vector<CutQuery> queries(const LodTree& tree, std::mt19937& random) {
  std::vector<Vec3f> centres = {{0, 0, 0}, {0, 0, -50}, {1e17f, 1e17f, -1e17f}, {-9.9e17f, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    const NodeRecord& r = tree.records[random() % tree.size()];
    const Vec3f middle = 0.5f * (r.box_min + r.box_max);
    centres.push_back(middle);
    centres.push_back({r.box_min.x, middle.y, middle.z});
    centres.push_back({middle.x, middle.y, std::nextafter(r.box_max.z, 1e30f)});
    centres.push_back(2.0f * r.box_max - middle);
  }
  std::vector<CutQuery> all;
  for (const Vec3f& c : centres) {
    for (const float target : {1e-30f, 1e-4f, 0.01f, 0.3f, 5.0f, 1e20f, kInfinity})
      all.push_back({c, target});
    // Exactly a node's size: < and >= must part there.
    const float size = tree.screen_size(static_cast<uint32_t>(random() % tree.size()), c);
    if (size > 0.0f) all.push_back({c, size});
  }
  return all;
}

TEST(Cut, EqualsTheRecursiveDefinitionAndMeetsEveryPathOnce) {
  Workers workers(2);
  std::mt19937 random(1);
  ExhaustiveSearch search;
  for (const TreeRule& rule : {TreeRule{}, test::kHierarchicalGs})
    for (const test::NamedCloud& named : test::all_clouds()) {
      SCOPED_TRACE(named.name);
      const LodTree tree = build_tree(named.cloud, workers, {}, rule).tree;
      for (const CutQuery& query : queries(tree, random)) {
        search.run(tree, {}, query, workers);
        const Expected expected = recursive_cut(tree, {}, query);
        ASSERT_TRUE(std::equal(search.cut().begin(), search.cut().end(), expected.cut.begin(),
                               expected.cut.end()))
            << "target size " << query.target_size;
        expect_every_path_met_once(tree, search.cut());
        EXPECT_EQ(search.nodes_tested(), tree.size());
        EXPECT_EQ(search.needed_missing(), kNoNode);
      }
    }
}

TEST(Cut, MissingNodesAreLeftOutAndNamed) {
  Workers workers(2);
  std::mt19937 random(2);
  ExhaustiveSearch search;
  const LodTree tree = build_tree(test::specks(20000, 2, 0), workers, {}, test::kSmallBlocks).tree;
  const uint32_t nodes = static_cast<uint32_t>(tree.size());
  const std::vector<std::vector<MissingNodes>> cases = {
      {{0, 1}},
      {{1, 1}},
      {{0, nodes}},
      {{nodes - 1, 1}},
      {{5, 40}, {100, 1}, {8190, 5}, {9000, 9000}},
      {{8192, 8192}},
      {{3, 1}, {4, 1}}};
  for (const std::vector<MissingNodes>& missing : cases) {
    LodTree damaged = tree;  // what a search may not read is poisoned
    uint64_t count = 0;
    for (const MissingNodes& m : missing) {
      count += m.count;
      for (uint32_t n = m.first; n < m.first + m.count; ++n) {
        const uint32_t children = damaged.records[n].child_count;
        for (uint32_t i = 0; i < children; ++i)
          damaged.parent[damaged.first_child[n] + i] = kNoNode;
        damaged.records[n] = {{NAN, NAN, NAN}, NAN, {NAN, NAN, NAN}, 0};
      }
    }
    for (const CutQuery& query : queries(tree, random)) {
      search.run(damaged, missing, query, workers);
      // The whole tree's cut, less what is missing and what has no parent to blend with.
      std::vector<uint32_t> expected = recursive_cut(tree, {}, query).cut;
      std::erase_if(expected, [&](uint32_t n) {
        return is_missing(missing, n) || (n > 0 && is_missing(missing, tree.parent[n]));
      });
      ASSERT_TRUE(
          std::equal(search.cut().begin(), search.cut().end(), expected.begin(), expected.end()));
      ASSERT_EQ(search.needed_missing(), recursive_cut(damaged, missing, query).needed_missing);
      EXPECT_EQ(search.nodes_tested(), tree.size() - count);
      for (const MissingNodes& m : missing) EXPECT_EQ(search.sizes()[m.first], kMissingSize);
    }
  }
}

TEST(Cut, DoesNotDependOnThreads) {
  Workers one(1), five(5);
  const LodTree tree = build_tree(test::specks(20000, 3, 0), one, {}, test::kSmallBlocks).tree;
  ExhaustiveSearch a, b;
  std::mt19937 random(3);
  const std::vector<MissingNodes> missing = {{700, 3}, {12000, 4000}};
  for (const CutQuery& query : queries(tree, random)) {
    a.run(tree, missing, query, one);
    b.run(tree, missing, query, five);
    ASSERT_EQ(a.cut(), b.cut());
    ASSERT_TRUE(std::equal(a.sizes().begin(), a.sizes().end(), b.sizes().begin(), b.sizes().end()));
    ASSERT_EQ(a.needed_missing(), b.needed_missing());
  }
}

TEST(Cut, SizesAreTheScreenSizes) {
  Workers workers(2);
  const LodTree tree =
      build_tree(test::random_cloud(3000, 4), workers, {}, test::kSmallBlocks).tree;
  ExhaustiveSearch search;
  const Vec3f c{3, -20, 7};
  search.run(tree, {}, {c, 0.1f}, workers);
  ASSERT_EQ(search.sizes().size(), tree.size());
  for (uint32_t n = 0; n < tree.size(); ++n) ASSERT_EQ(search.sizes()[n], size_of(tree, n, c));
}

TEST(Cut, SizesAreThoseOfTheStandardFloatingPointMode) {
  // A host that flushes subnormals to zero would turn a distance of 1e-24 m into "inside".
  Workers workers(2);
  GaussianCloud cloud = test::random_cloud(2, 5);
  for (size_t k = 0; k < 6; ++k) cloud.position[k] = cloud.log_scale[k] = 0.0f;
  const LodTree tree = build_tree(std::move(cloud), workers).tree;
  ExhaustiveSearch search;
  std::fenv_t saved;
  std::fegetenv(&saved);
  std::fesetround(FE_DOWNWARD);
  search.run(tree, {}, {{4, 4, 4}, 0.1f}, workers);
  std::fesetenv(&saved);
  EXPECT_EQ(search.sizes()[0], size_of(tree, 0, {4, 4, 4}));
}

TEST(Cut, AnEmptyTreeHasAnEmptyCut) {
  Workers workers(1);
  ExhaustiveSearch search;
  search.run(LodTree(), {}, {{0, 0, 0}, 1.0f}, workers);
  EXPECT_TRUE(search.cut().empty());
  EXPECT_EQ(search.nodes_tested(), 0u);
  EXPECT_EQ(search.needed_missing(), kNoNode);
}

class CountingResource final : public std::pmr::memory_resource {
 public:
  int allocations = 0;

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    ++allocations;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, size_t bytes, size_t alignment) override {
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

TEST(Cut, AllocatesNothingOnceWarm) {
  Workers workers(2);
  const LodTree tree = build_tree(test::specks(20000, 6, 0), workers, {}, test::kSmallBlocks).tree;
  CountingResource memory;
  ExhaustiveSearch search(&memory);
  search.run(tree, {}, {{1e6f, 0, 0}, 1e9f}, workers);
  ASSERT_EQ(search.cut().size(), 1u);
  const int warm = memory.allocations;
  for (const float target : {1e-6f, 0.1f, 10.0f})
    search.run(tree, {}, {{0, 0, 0}, target}, workers);
  EXPECT_EQ(memory.allocations, warm);
}

}  // namespace
}  // namespace voyager::cut_test
