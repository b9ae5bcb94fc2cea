// The sound search for one thread: images in, distances out.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/search/search.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

/// How far in the future an exposure may seem to lie, on clocks that agree not quite: it then counts as just as old.
inline constexpr double kClockTolerance_s = 0.005;

struct EvaluatorOptions {
  /// How many of the first capsules get hybrid_direction_world. Where there are others, the first have a quarter of the
  /// budget and the others the rest.
  std::size_t directions = 0;
  Budget budget{};  ///< of one evaluate()
  /// By the clock, now_s: what older images have shown frees nothing any more. A camera that delivers no more makes its
  /// space unknown after this, whatever v_max is. Greater than 0, at most an hour; the age of images that are still
  /// worth something is their latency, and the time between two.
  double max_image_age_s = 0.5;
  /// What was seen free is remembered for as long as nothing can have come there (docs/memory.md). Nothing: no memory.
  std::optional<memory::MemorySettings> memory{};
};

/// A ViewStore, a Search and, where it is asked for, a MemoryStore.
/// - Takes: frames of the rig's cameras; capsules in the world frame, metres; times in seconds on the frames' clock.
/// - Gives: an Answer for each capsule.
/// - Errors: the constructor throws Error; update() says what became of a frame.
/// - Threads: evaluate() and distance() one at a time; update() in others meanwhile, as ViewStore says.
///
/// distance_now_m is lower by v_max times the age of the images, which counts from the newest exposure: what may have
/// come nearer since. So the surveillance radius rho should exceed what a controller needs by v_max times the greatest
/// age. It is NaN when the images have no time, there are none, or they are from more than kClockTolerance_s after the
/// time asked for.
class SearchEvaluator final : public DistanceEvaluator {
 public:
  /// Throws Error as ViewStore does.
  SearchEvaluator(const Rig& rig, const views::Settings& settings, const EvaluatorOptions& options = {});

  [[nodiscard]] std::string_view name() const noexcept override { return "search"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return store_.rig().cameras.size(); }
  [[nodiscard]] double image_time_s(std::size_t camera) const noexcept override;
  [[nodiscard]] ImpossibleSurfaces impossible() const noexcept override { return impossible_; }
  [[nodiscard]] Past past(const Proximity& nearest) const noexcept override;
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame) noexcept override;
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame,
                                   const Pose& T_world_camera) noexcept override;
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override;

  /// Of one capsule, at the time of the newest image, or later.
  [[nodiscard]] Answer distance(const Capsule& capsule) noexcept;
  [[nodiscard]] Answer distance(const Capsule& capsule, double now_s) noexcept;

  /// What it has seen, for pictures and for other threads' own searches.
  [[nodiscard]] const views::ViewStore& store() const noexcept { return store_; }
  /// Null without memory. What the robot puts down or lets go has to be said to it: MemoryStore::occupy().
  [[nodiscard]] memory::MemoryStore* memory() noexcept { return memory_.get(); }
  [[nodiscard]] const memory::MemoryStore* memory() const noexcept { return memory_.get(); }

 private:
  void evaluate(const views::Snapshot& snapshot, std::span<const Capsule> capsules, double now_s,
                std::span<Answer> answers) noexcept;

  /// Images from before this count for nothing.
  [[nodiscard]] double oldest_s(double now_s) const noexcept;
  [[nodiscard]] FrameUpdate remembered(std::size_t camera, FrameUpdate update) noexcept;

  views::ViewStore store_;
  std::unique_ptr<memory::MemoryStore> memory_;
  Search search_;
  EvaluatorOptions options_;
  std::array<double, views::kMaxCameras> image_times_s_{};  ///< of the newest answers
  ImpossibleSurfaces impossible_;                           ///< and the same
};

}  // namespace depthgrid::search
