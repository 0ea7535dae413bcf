#include "runtime/scene/import/tileset/tileset.h"

#include <algorithm>
#include <map>

#include "runtime/scene/import/gltf/parts.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/tileset/contents.h"
#include "runtime/scene/tileset_format.h"
#include "runtime/scene/transform.h"

namespace voyager::tileset {
namespace {

Affine in_inria_axes(const Affine& transform) {
  return {kToInria * transform.linear * kToInria, kToInria * transform.offset};
}

// The file of a content, opened where nobody has it open.
class Shared {
 public:
  Shared(std::shared_ptr<const ByteSource> first, Content content)
      : first_(std::move(first)), content_(std::move(content)) {}

  std::shared_ptr<const gltf::Scene> open() {
    if (auto scene = open_.lock()) return scene;
    gltf::File file(open_content(*first_, content_));
    auto scene = std::make_shared<const gltf::Scene>(std::move(file));
    open_ = scene;
    return scene;
  }

 private:
  std::shared_ptr<const ByteSource> first_;
  Content content_;
  std::weak_ptr<const gltf::Scene> open_;
};

// Tiles that name one file come one after the other, so that it is opened once for all of them, now
// and when its turn comes.
void group_by_file(std::vector<Content>& contents) {
  std::map<std::string, size_t> first;
  for (size_t i = 0; i < contents.size(); ++i) first.try_emplace(contents[i].uri, i);
  std::stable_sort(contents.begin(), contents.end(),
                   [&](const Content& a, const Content& b) { return first[a.uri] < first[b.uri]; });
}

class Parts {
 public:
  explicit Parts(std::shared_ptr<const ByteSource> first) : first_(std::move(first)) {
    total_bytes_ = bytes_[first_->name()] = first_->size();
  }

  std::unique_ptr<BlockReader> read(std::vector<Content> contents) {
    if (contents.empty())
      refuse(first_->name(), 0, "root", "no content of a leaf", "at least one glTF file");
    origin_ = origin_near(in_inria_axes(contents.front().transform).offset);
    group_by_file(contents);
    for (Content& content : contents) add(std::move(content));
    return merge_blocks(first_->name(), std::move(parts_), origin_);
  }

  const LeftOut& left_out() const { return left_out_; }

 private:
  void add(Content content) {
    const Affine place = in_inria_axes(content.transform);
    const std::string name = content.place;
    std::shared_ptr<Shared>& known = shared_[content.uri];
    const bool is_new = !known;
    if (is_new) known = std::make_shared<Shared>(first_, std::move(content));
    const std::shared_ptr<Shared> shared = known;
    const auto scene = last_ = shared->open();
    if (is_new) {
      count_bytes(*scene);
      left_out_.add(scene->left_out());
    }
    for (BlockPart& part : gltf::parts_of(
             *scene, [shared] { return shared->open(); }, place, origin_, name)) {
      if (__builtin_add_overflow(count_, part.count, &count_)) count_ = UINT64_MAX;
      sh_degree_ = std::max(sh_degree_, part.sh_degree);
      parts_.push_back(std::move(part));
    }
    require_worth();
  }

  void count_bytes(const gltf::Scene& scene) {
    for (const auto& [path, size] : scene.bytes()) {
      uint64_t& used = bytes_[path];
      total_bytes_ += size - std::min(used, size);
      used = std::max(used, size);
    }
  }

  // With each content, before the next is opened.
  void require_worth() const {
    const uint64_t parts = most_parts(total_bytes_);
    if (parts_.size() > parts)
      refuse(first_->name(), 0, "placed primitives", std::to_string(parts_.size()),
             "at most " + std::to_string(parts));
    const uint64_t most = most_gaussians(total_bytes_, bytes_of_gaussian(sh_degree_));
    if (count_ > most)
      refuse(first_->name(), 0, "Gaussians", std::to_string(count_),
             "at most " + std::to_string(most) + " in " + std::to_string(total_bytes_) + " bytes");
  }

  std::shared_ptr<const ByteSource> first_;
  std::vector<BlockPart> parts_;
  std::map<std::string, std::shared_ptr<Shared>> shared_;  // by URI
  std::shared_ptr<const gltf::Scene> last_;                // open, for tiles that repeat it
  std::map<std::string, uint64_t> bytes_;                  // as gltf::File::bytes()
  uint64_t total_bytes_ = 0;                               // of all of them
  LeftOut left_out_;
  std::array<double, 3> origin_{};
  uint64_t count_ = 0;
  int sh_degree_ = 0;
};

}  // namespace

bool is_tileset(const nlohmann::json& json) {
  return json.is_object() && json.contains("root");
}

std::unique_ptr<BlockReader> open(std::shared_ptr<const ByteSource> source, nlohmann::json json) {
  std::vector<Content> contents = list_contents(*source, std::move(json));
  return Parts(std::move(source)).read(std::move(contents));
}

LeftOut left_out(std::shared_ptr<const ByteSource> source, nlohmann::json json) {
  std::vector<Content> contents = list_contents(*source, std::move(json));
  Parts parts(std::move(source));
  parts.read(std::move(contents));
  return parts.left_out();
}

}  // namespace voyager::tileset
