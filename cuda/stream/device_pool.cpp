#include "cuda/stream/device_pool.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cuda/interop/external_ring.h"
#include "cuda/scene/device_gaussian.h"
#include "runtime/base/error.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/stream/search_chunks.h"

namespace voyager::cuda {
namespace {

// Enough to keep the bus busy, and no more: what links chunks waits for those before it.
constexpr size_t kMostPieces = 32, kLeastPieces = 4, kRingBytes = size_t{8} << 20;
constexpr size_t kPieceBytes = size_t{256} << 10;  // unless one chunk takes more

// So many share a launch and an event.
size_t chunks_a_piece(const PoolLayout& chunk) {
  return std::clamp<size_t>(kPieceBytes / chunk.filled_bytes(), 1, PoolFill::kMostChunks);
}

size_t piece_bytes(const PoolLayout& chunk) {
  return chunks_a_piece(chunk) * chunk.filled_bytes();
}

size_t pieces_of(const PoolLayout& chunk) {
  return std::clamp(kRingBytes / piece_bytes(chunk), kLeastPieces, kMostPieces);
}

bool shares_memory(const Device& device) {
  int integrated = 0;
  check(cudaDeviceGetAttribute(&integrated, cudaDevAttrIntegrated, device.ordinal()),
        "device attribute");
  return integrated != 0;
}

template <class T>
void put(unsigned char* into, size_t index, const T& value) {
  std::memcpy(into + index * sizeof(T), &value, sizeof(T));
}

static_assert(kMaxChunkBytes / sizeof(NodeRecord) <= 0x10000);  // what owner codes can say

void check_addresses(SlotShape shape, PoolRoom room) {
  const uint64_t nodes = uint64_t{room.slots} * shape.nodes,
                 records = uint64_t{room.blocks} * kRecordBlock;
  if (std::max(nodes, records) < kNotLinked) return;
  throw Error(ErrorCode::unsupported, "streaming: found room for " + std::to_string(nodes) +
                                          " nodes and " + std::to_string(records) +
                                          " search records, expected fewer than 2^32 - 2");
}

// Of one chunk.
PoolLayout chunk_layout(const Scene& scene, SlotShape shape) {
  return {scene, shape, {1, record_blocks(shape.records)}};
}

}  // namespace

PoolBytes DevicePool::bytes(const Device& device, const Scene& scene, SlotShape shape) {
  const PoolLayout chunk = chunk_layout(scene, shape);
  PoolBytes bytes = chunk.pool_bytes();
  if (is_coded(scene)) bytes.fixed += CodeTables::kBytes;
  if (shares_memory(device)) bytes.fixed += pieces_of(chunk) * piece_bytes(chunk);
  return bytes;
}

DevicePool::DevicePool(std::shared_ptr<const Device> device, const Scene& scene,
                       std::shared_ptr<const SceneFile> file, SlotShape shape, PoolRoom room)
    : device_(std::move(device)),
      tables_(is_coded(scene) ? device_->code_tables() : nullptr),
      shape_(shape),
      sh_degree_(scene.sh_degree),
      sh_form_(sh_form(scene)),
      doubles_(scene.doubles),
      footprints_(footprints_differ(scene)),
      blend_share_(scene.tree.blend_share),
      file_(std::move(file)),
      chunk_layout_(chunk_layout(scene, shape)),
      layout_(chunk_layout_),
      ring_(piece_bytes(chunk_layout_), pieces_of(chunk_layout_)) {
  make_room(room);
}

// There is none yet.
void DevicePool::make_room(PoolRoom room) {
  check_addresses(shape_, room);
  layout_.set_room(room);
  memory_ = Buffer<unsigned char>(layout_.bytes());
  bounds_.make_room(room.slots);
  slot_ids_.assign(room.slots, {});
  slots_ = room.slots;
  pages_ = room.pages;
  families_ = room.families;
  check(cudaMemset(array<SearchChunk>(kChunks), 0, slots_ * layout_.slot_bytes(kChunks)), "links");
  check(cudaMemset(array<uint32_t>(kPages), 0, layout_.fixed_bytes(kPages)), "links");
  check(cudaMemset(array<uint32_t>(kLargeFamilyCount), 0, layout_.fixed_bytes(kLargeFamilyCount)),
        "links");
  check(cudaStreamSynchronize(nullptr), "links");
  launch_unlink_all(array<SearchSubtree>(kSubtrees), place_count(), stream_.get());
  applied_.record(stream_.get());
}

void DevicePool::await_frames() {
  device_->use();
  put_behind_frames();
  wait_for_host(stream_);
}

void DevicePool::await_links() const {
  wait_for_host(applied_);
}

void DevicePool::resize(PoolRoom room) {
  device_->use();
  put_behind_frames();
  stream_.wait();
  slots_ = 0;
  memory_ = {};
  make_room(room);
}

// What it frees belongs to the device's context, and to chunks that may be on their way.
DevicePool::~DevicePool() {
  device_->use_quietly();
  stream_.wait_quietly();
}

GaussianView DevicePool::gaussians() const {
  return {array<unsigned char>(kHulls),
          array<unsigned char>(kShapes),
          array<float>(kOpacities),
          array<uint8_t>(kNodeCodes),
          {nullptr,
           nullptr,
           {nodes(),
            array<SearchSubtree>(kSubtrees),
            array<uint32_t>(kOutside),
            {array<uint32_t>(kPages)}}},
          array<uint32_t>(kChildCounts),
          array<LargeFamily>(kLargeFamilies),
          array<uint32_t>(kLargeFamilyCount),
          array<uint4>(kCoefficients),
          sh_degree_,
          sh_form_,
          doubles_,
          footprints_,
          slots_ * shape_.nodes,
          tables_ == nullptr ? ShapeTables{} : tables_->view(),
          array<ShStepSizes>(kStepSizes),
          array<MeanGrid>(kMeanGrids),
          {nullptr, shape_.nodes}};
}

PoolNodes DevicePool::nodes() const {
  const auto stride = static_cast<uint32_t>(layout_.unit(kOwners));
  const uint32_t* const first = array<uint32_t>(kFirstSubtrees);
  if (stride != 0) return {array<unsigned char>(kOwners), stride, first, shape_.nodes};
  return {array<unsigned char>(kShapes) + offsetof(ShapeRest, children), sizeof(ShapeRest), first,
          shape_.nodes};
}

TreeView DevicePool::tree() const {
  return {array<SearchSubtree>(kSubtrees),
          {array<uint32_t>(kPages)},
          array<SearchRecord>(kRecords),
          array<uint32_t>(kNextBlocks),
          array<SearchChunk>(kChunks),
          layout_.unit(kLeaves) == 0 ? nullptr : array<NodeRecord>(kLeaves),
          file_->info().subtree_count,
          place_count(),
          slots_,
          blend_share_};
}

// As pool_fill copies it into the slot.
void DevicePool::pack(const StagedChunk& staged, unsigned char* into) const {
  const Chunk& chunk = staged.content;
  const auto at = [&](PoolArray which) { return into + chunk_layout_.begin(which); };
  for (size_t i = 0; i < chunk.node.size(); ++i) {
    const uint32_t owner = staged.owner[i], place = staged.place[i];
    if (layout_.unit(kOwners) == 1)
      put(at(kOwners), place, static_cast<uint8_t>(owner));
    else if (layout_.unit(kOwners) != 0)
      put(at(kOwners), place, static_cast<uint16_t>(owner));
    if (layout_.unit(kLeaves) != 0) put(at(kLeaves), place, chunk.record_of(i));
  }
  if (sh_form_ == ShForm::coded)
    pack_codes(staged, into);
  else
    pack_floats(staged, into);
  put(at(kFirstSubtrees), 0, staged.links.first_subtree);
  std::memcpy(at(kRecords), staged.records.data(), staged.records.size() * sizeof(SearchRecord));
  std::memcpy(at(kNextBlocks), staged.blocks.data(), staged.blocks.size() * sizeof(uint32_t));
}

void DevicePool::pack_codes(const StagedChunk& staged, unsigned char* into) const {
  const Chunk& chunk = staged.content;
  const auto at = [&](PoolArray which) { return into + chunk_layout_.begin(which); };
  for (size_t i = 0; i < chunk.node.size(); ++i) {
    ShapeCode code = shape_code(chunk, i);
    const uint32_t place = staged.place[i];
    unsigned char* const row = at(kCoefficients) + place * layout_.unit(kCoefficients);
    put_row(chunk, i, sh_degree_, row);
    if (layout_.unit(kOwners) == 0) {
      row[sh_spare_byte(sh_degree_)] = code.rest.children;
      code.rest.children = static_cast<uint8_t>(staged.owner[i]);
    }
    put(at(kHulls), place, CodedHull{chunk.mean_code[i], code.bounds});
    put(at(kShapes), place, code.rest);
  }
  put(at(kStepSizes), 0, step_sizes(chunk.sh_scale));
  put(at(kMeanGrids), 0, chunk.mean_grid);
}

void DevicePool::pack_floats(const StagedChunk& staged, unsigned char* into) const {
  const Chunk& chunk = staged.content;
  const auto at = [&](PoolArray which) { return into + chunk_layout_.begin(which); };
  const size_t floats = 3 * static_cast<size_t>(sh_coefficients(sh_degree_));
  for (size_t i = 0; i < chunk.node.size(); ++i) {
    const Gaussian g = activate(chunk.words[i], chunk.has_logit(i));
    const size_t place = staged.place[i];
    put(at(kHulls), place, device_hull(g));
    put(at(kShapes), 2 * place, device_shape(g, 0));
    put(at(kShapes), 2 * place + 1, device_shape(g, 1));
    put(at(kOpacities), place, g.opacity);
    put(at(kNodeCodes), place, chunk.node_code[i]);
    put(at(kChildCounts), place, chunk.record_of(i).child_count);
    unsigned char* const sh = at(kCoefficients) + place * layout_.unit(kCoefficients);
    if (sh_form_ == ShForm::half)
      put_half_coefficients(&chunk.sh[i * floats], sh_degree_, reinterpret_cast<__half*>(sh));
    else
      std::memcpy(sh, &chunk.sh[i * floats], floats * sizeof(float));
  }
}

void DevicePool::fill(std::span<const StagedChunk* const> chunks) {
  const std::shared_ptr<void> kept = keep_context();  // the thread may be the host's
  device_->use();
  require_room();
  const size_t most = chunks_a_piece(chunk_layout_);
  for (; !chunks.empty(); chunks = chunks.subspan(std::min(most, chunks.size())))
    fill_piece(chunks.first(std::min(most, chunks.size())));
}

void DevicePool::fill_piece(std::span<const StagedChunk* const> chunks) {
  const UploadRing::Piece piece = ring_.take();
  PoolFill fill{piece.device(),
                memory_.data(),
                chunk_layout_.filled_bytes(),
                static_cast<uint32_t>(chunks.size()),
                {},
                {}};
  for (uint32_t a = 0; a < kFilledArrays; ++a) {
    const auto which = static_cast<PoolArray>(a);
    fill.arrays[a] = {chunk_layout_.begin(which), layout_.begin(which),
                      static_cast<uint32_t>(layout_.slot_bytes(which)),
                      static_cast<uint32_t>(layout_.unit(which))};
  }
  const auto count = [](const auto& all) { return static_cast<uint32_t>(all.size()); };
  for (size_t c = 0; c < chunks.size(); ++c) {
    const StagedChunk& chunk = *chunks[c];
    pack(chunk, piece.host() + c * fill.chunk_bytes);
    bounds_.fill(chunk);
    fill.chunks[c] = {chunk.links.slot,
                      {count(chunk.content.node), count(chunk.records), count(chunk.blocks), 1}};
  }
  launch_fill(fill, stream_.get());
  piece.read_by(stream_.get());
}

// What may fail comes before what is launched.
void DevicePool::apply(const LinkPatch& patch) {
  device_->use();
  require_room();
  if (patch.large && tables_ != nullptr && patch.large->size() > families_)
    throw Error(ErrorCode::internal, "streaming: found " + std::to_string(patch.large->size()) +
                                         " large families, expected at most " +
                                         std::to_string(families_));
  const PoolPatch copy = patches_.put(patch, *file_);
  put_behind_frames();
  launch_patch(
      {array<SearchSubtree>(kSubtrees), array<uint32_t>(kPages), array<SearchRecord>(kRecords),
       array<uint32_t>(kOutside), array<SearchChunk>(kChunks),
       tables_ == nullptr ? nullptr : array<LargeFamily>(kLargeFamilies),
       array<uint32_t>(kLargeFamilyCount)},
      copy, stream_.get());
  patches_.read_by(stream_.get());
  applied_.record(stream_.get());
  for (const LinkPatch::Arrived& arrived : patch.arrived) slot_ids_[arrived.slot] = arrived.ids;
}

void DevicePool::require_room() const {
  if (slots_ == 0)
    throw Error(ErrorCode::over_budget,
                "streaming: found no memory for any slot when a budget changed, expected some");
}

// What comes on the stream from now on.
void DevicePool::put_behind_frames() {
  const std::lock_guard lock(readers_mutex_);
  for (PoolReader* reader : readers_)
    if (std::exchange(reader->reading_, false))
      check(cudaStreamWaitEvent(stream_.get(), reader->ended_.get(), 0), "frames in flight");
}

DevicePool& pool_of(const Scene& scene, const Device& device) {
  auto* pool = dynamic_cast<DevicePool*>(scene.pool.get());
  if (pool != nullptr && &pool->device() == &device) return *pool;
  throw Error(
      ErrorCode::unsupported,
      "scene: found a scene that is streamed to another device, expected the view's device");
}

PoolReader::PoolReader(DevicePool& pool) : pool_(pool) {
  const std::lock_guard lock(pool_.readers_mutex_);
  pool_.readers_.push_back(this);
}

PoolReader::~PoolReader() {
  const std::lock_guard lock(pool_.readers_mutex_);
  std::erase(pool_.readers_, this);
}

void PoolReader::begin(cudaStream_t stream) const {
  pool_.require_room();
  check(cudaStreamWaitEvent(stream, pool_.applied_.get(), 0), "links");
}

void PoolReader::end(cudaStream_t stream) noexcept {
  reading_ = cudaEventRecord(ended_.get(), stream) == cudaSuccess || reading_;
}

}  // namespace voyager::cuda
