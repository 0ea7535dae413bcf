#pragma once
// Keeps the chunks of one scene coming: threads that read and decode what residency asks
// for, and what a frame does about it. A frame waits for none of it unless it says so.
#include <atomic>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/team.h"
#include "runtime/base/workers.h"
#include "runtime/format/reader.h"
#include "runtime/stream/chunk_pool.h"
#include "runtime/stream/failures.h"
#include "runtime/stream/fit_room.h"
#include "runtime/stream/linker.h"
#include "runtime/stream/residency.h"

namespace voyager {

struct StreamDesc {
  PoolRoom room{};
  // Of the same file, which they refer to; none: they are found.
  std::optional<RecordRoom> records;
  std::shared_ptr<const ChunkGraph> graph;
  uint32_t pinned = 0;               // as Residency has it
  uint32_t first = 0;                // chunks that read_top() reads, from pinned to what fits
  unsigned readers = 2;              // threads; 0: step() does it all
  uint64_t read_bytes = 1 << 18;     // of one read, at most, unless one chunk has more
  uint64_t staged_bytes = 32 << 20;  // stored bytes of what was read and has no slot yet
  RoomBytes bytes{};
  uint64_t budget = 0;  // for all of them; 0: no limit
  // Told what all of them take: before that is more, for which it may throw, and after it is less.
  // What they take at first it knows.
  std::function<void(uint64_t)> count;
  // Seconds, for what is tried again and how long frames take; any thread. None: the machine's.
  std::function<double()> clock;
};

// Of the scene, since it was opened.
struct StreamCounters {
  ResidencyCounters chunks;
  uint64_t reads = 0, bytes_read = 0;
  uint64_t failures = 0;  // of reads and of chunks
  uint32_t slots = 0, resident = 0;
  ResidencyNeed need;
};

// What linking has changed, for searches that go on from their last cut.
struct StreamChange {
  uint64_t version;                         // from 1
  std::vector<uint32_t> unlinked, changed;  // as PartitionedSearch::relink() takes them
  std::vector<LinkPatch::Arrived> arrived;
};

class SceneStream {
 public:
  // The pool outlives it. Nothing is read before read_top().
  SceneStream(std::shared_ptr<const SceneFile> file, const StreamDesc& desc, ChunkPool& pool);
  ~SceneStream();
  SceneStream(const SceneStream&) = delete;
  SceneStream& operator=(const SceneStream&) = delete;

  // What a chunk of the file takes at most.
  static SlotShape slot_shape(const SceneFile& file);
  // How many of the first chunks hold a subtree of the tree's root.
  static uint32_t top_chunks(const SceneFile& file);
  // How many of the first chunks stay whoever looks, where there are so many slots.
  static uint32_t pinned_chunks(const SceneFile& file, uint32_t slots);

  // Reads the first chunks, and starts the threads. Once, before any frame. Throws Error as the
  // source does, and where a chunk that is pinned is damaged: a scene without its top is nothing.
  void read_top(Workers& workers);
  // Then: what is large from a point, in the scene's own coordinates, until about so many stored
  // bytes of it are there, or a second has passed. What cannot be had is left out.
  void read_around(const Vec3f& centre, uint64_t bytes);
  // Another budget, with as much room as fits, and no more pinned than at first: what was there
  // goes, but for what is pinned. Waits for frames that hold the pool, and for no source. Throws
  // as fit_room() and ChunkPool::resize() do; the stream has then as much room as before, if that
  // was to be had.
  void set_budget(uint64_t budget, Workers& workers);
  // Other room, whatever the budget, and so many pinned.
  void resize(PoolRoom room, uint32_t pinned, Workers& workers);
  // As PoolShare has them. Any thread.
  void add_state(PoolReaderState& state, Workers& workers);
  void remove_state(PoolReaderState& state) noexcept;
  // Ends the threads; nothing comes any more. Also done when it is destroyed.
  void stop();
  // Nobody should wait for anything any more: wait() throws Error(scene_closed), and reads end.
  // Any thread, also while others wait.
  void abandon() noexcept;

  // Who looks, for one view's instance; it replaces what was said before. No viewers: nobody.
  // Any thread.
  void look(const void* who, std::vector<Viewer> viewers);
  // Whether a frame is to tell what it shows: something that is seen is to be asked for. Any
  // thread.
  bool wants_shown() const { return shown_wanted_; }
  // What a frame of `who` has shown, where it was wanted. Any thread.
  void tell_shown(const void* who, const ShownChunks& shown);
  // What has come becomes resident, as far as the stream's own threads have not seen to that
  // between frames, and as far as a millisecond suffices, or a tenth of the time from one call to
  // the next. Whoever holds the pool (frames that read it, a thread that links) puts that off for a
  // tenth of a second; then the call waits for them to end. It never waits for a plan: one that is
  // being made puts that off to the next call. Any thread.
  void commit();
  // All that comes becomes resident, until nothing more is to come. Throws Error(over_budget) where
  // what is seen does not fit, and unless `stand_in` what kept a chunk that is seen from coming:
  // what failed for good, or often, or because the source as a whole has failed often. Gives
  // departures() as of the moment when all was there.
  uint64_t wait(bool stand_in);
  // How often chunks that are seen have gone: for others, or because slots were filled anew. Under
  // hold().
  uint64_t departures() const { return departures_; }

  // Held while a frame reads the pool, and what changes with it. Of several streams, in the order
  // of their addresses. Throws what ChunkPool::apply() threw, until the pool has been filled anew:
  // what is linked is not what the pool has.
  std::shared_lock<std::shared_mutex> hold() const;
  uint64_t version() const { return version_; }
  // The changes after a version, in their order; false where those are no longer known.
  bool changes_since(uint64_t version, std::vector<std::shared_ptr<const StreamChange>>& out) const;

  const SceneFile& file() const { return *file_; }
  uint32_t pinned() const { return desc_.pinned; }
  // What the pool takes, and its views, of which there is room for one at least.
  uint64_t bytes() const { return bytes_; }
  // No cut has more nodes. Under hold().
  uint64_t cut_nodes() const { return desc_.bytes.list.nodes(room_); }
  // As of the last step or commit. Any thread.
  StreamCounters counters() const;
  // What went wrong, each cause once. Any thread.
  std::vector<std::string> take_messages();

  // One step of planning, filling or reading, for a stream without threads. False: there is
  // nothing to do until a frame has looked or committed, or time has passed.
  bool step();

 private:
  using Lock = std::unique_lock<std::mutex>;
  using TimePoint = std::chrono::steady_clock::time_point;
  // in_time: what is asked for goes on without it. soon: what is asked for may be wrong. at_once:
  // somebody looks who has not looked before.
  enum class PlanAsked : uint8_t { no, in_time, soon, at_once };
  static constexpr size_t kChangesKept = 64;
  static constexpr uint32_t kMostAtOnce = 16;  // chunks: a thread decodes them in two milliseconds
  // How many chunks one commit links at most, and unlinks at most. The few take one thread a
  // millisecond.
  static constexpr size_t kFewChunks = 64, kAllChunks = SIZE_MAX;
  // Threads that link at once. More would wait for one another longer than they link.
  static constexpr unsigned kMostThatLink = 8;

  // Read, and not resident yet.
  struct Coming {
    StagedChunk chunk;
    uint64_t stored_bytes;
  };

  void run();
  bool step(Lock& lock);
  bool work(Lock& lock);
  bool plan_is_asked();
  bool plan_if_asked(Lock* lock);
  bool order_if_told();
  void forget_shown();
  void forget_shown(const std::vector<Residency::Evicted>& evicted);
  TimePoint look_at_likely(Lock& lock);
  bool retry_due();
  bool fill_some(Lock& lock);
  bool is_far_ahead() const;
  bool read_some(Lock& lock);
  void stage(ChunkRange range, std::span<const std::byte> stored, Lock& lock);
  StagedChunk* add_coming(uint32_t chunk, StagedChunk&& staged);
  StagedChunk* put(uint32_t chunk);
  void fill(const std::vector<StagedChunk*>& some, Lock& lock);
  void put_first(uint32_t count, std::span<const std::byte> stored, Workers& workers);
  void fail(uint32_t chunk, const std::exception& error);
  void fail(uint32_t chunk, const std::exception_ptr& failure);
  void add_failure(uint32_t chunk, const Error& error);
  void forget(uint32_t chunk);
  void ask_for_plan(PlanAsked when);
  TimePoint next_plan() const;
  bool rests(TimePoint until) const;
  static size_t most_for_frame(double seconds);
  size_t enough_between_frames() const;
  bool commit_between_frames(Lock& lock);
  struct Commit;
  void commit_or_lose(size_t most, Lock& lock);
  void commit_all(size_t most, Lock* lock);
  size_t commit_changes(size_t most, Lock* lock);
  Commit begin_commit(size_t most);
  void link(Commit& commit);
  void end_commit(const Commit& commit);
  void note_changes();
  std::shared_ptr<const StreamChange> change_of(const LinkPatch& patch) const;
  std::optional<SubtreePages> no_pages(PoolRoom room) const;
  void lose(std::exception_ptr what) noexcept;
  bool rebuild_if_due(Lock& lock);
  void rebuild();
  std::unique_lock<std::shared_mutex> hold_alone() const;
  void apply(const LinkPatch& patch);
  void place_subtrees(const ChunkEntry& chunk, std::vector<uint32_t>& moved_pages);
  void change_room(PoolRoom room, uint32_t pinned, Workers& workers);
  template <class Change>
  void change_bytes(PoolRoom room, size_t states, const Change& change);
  void reset(PoolRoom room, uint32_t pinned, Workers& workers);
  StagedChunk decode(uint32_t chunk, std::span<const std::byte> stored) const;
  template <class Done>
  void work_until(const Done& done, double deadline);
  template <class Done>
  bool work_once(const Done& done, bool& first, bool& stepped);
  void check_fits() const;
  void check_cut() const;
  [[noreturn]] void refuse_room(PoolRoom enough) const;
  bool is_settled(double since) const;
  void check_seen() const;
  std::vector<std::byte> read(ChunkRange range, std::optional<Error>& failure, Lock& lock);
  void pace_reads(double seconds);
  void fail_range(ChunkRange range, const Error& error, uint64_t generation);
  void stage_range(ChunkRange range, const std::vector<std::byte>& bytes, uint64_t generation,
                   Lock& lock);
  void publish();
  void signal();
  void wake_threads();
  double now() const;
  double next_due() const;

  const std::shared_ptr<const SceneFile> file_;
  const StreamDesc desc_;
  const Tiers tiers_;
  const ChunkGraph& graph_;
  const SlotShape shape_;
  const RecordRoom& records_;
  ChunkPool& pool_;

  // Guards what the budget is shared out to. Taken before all other locks.
  std::mutex sharing_;
  uint64_t budget_;
  PoolRoom room_;  // changed under the pool's lock and mutex_, too
  uint32_t room_pinned_;
  std::vector<PoolReaderState*> states_;
  std::atomic<size_t> state_count_{0};
  std::atomic<uint64_t> bytes_;

  // The pool's: held alone while that changes, before mutex_. Whoever takes it passes the door, so
  // that frames that follow one another without end keep nobody out.
  mutable std::mutex door_;
  mutable std::shared_mutex pool_mutex_;
  std::atomic<bool> commit_due_{false}, shown_wanted_{false};
  std::atomic<size_t> changes_due_{0};       // chunks for the next commit
  std::atomic<unsigned> between_frames_{0};  // commits since the last frame
  std::atomic<double> last_frame_{0};        // when it committed
  std::atomic<unsigned> waits_{0};           // calls that wait: meanwhile plans are whole
  std::atomic<double> put_off_{-1};  // since when a commit is due; negative: none was put off
  std::deque<std::shared_ptr<const StreamChange>> changes_;
  uint64_t version_ = 0, departures_ = 0;
  // What kept the pool from being what is linked. Changed under both locks, read under either.
  std::exception_ptr unsound_;

  // Held only to copy something; after mutex_.
  mutable std::mutex small_mutex_;
  std::condition_variable wake_, progress_;
  uint64_t signals_ = 0;
  bool stopping_ = false, abandoned_ = false;
  PlanAsked asked_ = PlanAsked::no;
  struct Looker {
    std::vector<Viewer> viewers;
    ShownChunks shown;  // none: no frame has told
  };
  std::map<const void*, Looker> lookers_;
  bool told_ = false;  // one of those has changed
  StreamCounters published_;
  std::vector<std::string> messages_;

  // Of all that follows; a plan may hold it for milliseconds.
  std::mutex mutex_;
  ChunkLooks looks_;  // also without the lock, by the thread that has set planning_
  // A thread looks at chunks without the lock, or waits until none is linked; no other may plan.
  bool planning_ = false;
  // A commit links without the lock, but with the pool held alone; no one may plan, and only it and
  // threads that help it touch linker_, pages_ or what it has taken of coming_.
  bool linking_ = false;
  std::condition_variable linked_;
  Team team_;                // for a commit: whoever makes one, and the stream's threads
  bool plan_waits_ = false;  // for linked_; no further commit begins between frames
  Residency residency_;
  Linker linker_;
  std::optional<SubtreePages> pages_;  // where the pool's tables are by page
  std::map<uint32_t, Coming> coming_;  // by chunk
  std::deque<uint32_t> ready_;         // those of them without a slot
  uint64_t staged_bytes_ = 0;
  TimePoint next_plan_, next_plan_in_time_;
  // Of the pool's present slots: what a thread has begun for earlier ones is for nothing.
  std::atomic<uint64_t> generation_{0};
  unsigned filling_ = 0;
  // In flight, and how many may be (pace_reads()).
  unsigned reads_in_flight_ = 0, reads_allowed_ = UINT_MAX, most_reads_ = UINT_MAX;
  // What ended a step or a commit halfway, for want of memory: what is resident, wanted and linked
  // is then no longer known, though frames may go on with the pool. All is filled anew.
  std::exception_ptr lost_;
  double rebuild_due_ = 0;
  std::condition_variable filled_;
  std::vector<std::byte> top_;  // stored bytes of what is pinned
  ResidencyCounters counted_;   // for earlier slots
  Failures failures_;
  uint64_t reads_ = 0, bytes_read_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace voyager
