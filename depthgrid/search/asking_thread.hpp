// Distances asked for in a thread of their own: what a control loop reads costs it no search.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/core/triple_buffer.hpp"
#include "depthgrid/search/search_evaluator.hpp"

namespace depthgrid::search {

struct AskingOptions {
  std::size_t capsules = 64;  ///< most of one call; further answers are not_evaluated
  double period_s = 0.002;    ///< between the beginnings of two questions; a longer one delays the next
  double max_age_s = 0.1;     ///< answers to older questions are not_evaluated: the thread hangs or has no time
};

/// - Takes, gives, errors: as SearchEvaluator. The constructor throws Error, and std::system_error without threads.
/// - evaluate() hands its capsules to the thread, and returns at once with the newest answers that the thread has
///   finished, carried over to the capsules and the time asked for now (see carried_answer.hpp): still lower bounds,
///   smaller by what the robot has moved since, and by v_max times that time. not_evaluated before the first answer.
/// - The i-th capsule of a call is compared with the i-th of earlier calls: keep their order.
/// - Threads: evaluate() one at a time; update() in others meanwhile, as ViewStore says. evaluate() takes microseconds,
///   and does not wait for the search.
class AskingThread final : public DistanceEvaluator {
 public:
  /// The evaluator must outlive it; nobody else evaluates with it meanwhile.
  explicit AskingThread(SearchEvaluator& evaluator, const AskingOptions& options = {});
  ~AskingThread() override;
  AskingThread(const AskingThread&) = delete;
  AskingThread& operator=(const AskingThread&) = delete;

  [[nodiscard]] std::string_view name() const noexcept override { return "search in a thread"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return evaluator_.camera_count(); }
  [[nodiscard]] double image_time_s(std::size_t camera) const noexcept override;
  [[nodiscard]] ImpossibleSurfaces impossible() const noexcept override { return replies_.front().impossible; }
  [[nodiscard]] Past past(const Proximity& nearest) const noexcept override { return evaluator_.past(nearest); }
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame) noexcept override;
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame,
                                   const Pose& T_world_camera) noexcept override;
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override;

  /// Questions that the thread has answered so far.
  [[nodiscard]] std::uint64_t answered() const noexcept { return answered_.load(std::memory_order_relaxed); }
  /// For its priority and its core.
  [[nodiscard]] std::thread::native_handle_type native_handle() { return thread_.native_handle(); }

 private:
  struct Question {
    explicit Question(std::size_t room) : capsules(room) {}
    std::vector<Capsule> capsules;
    std::size_t count = 0;
    double now_s = Proximity::kNaN;
  };
  struct Reply {
    explicit Reply(std::size_t room) : question(room), answers(room) { image_times_s.fill(Proximity::kNaN); }
    Question question;
    std::vector<Answer> answers;
    std::array<double, views::kMaxCameras> image_times_s{};
    ImpossibleSurfaces impossible;
  };

  void ask_until_stopped(const std::stop_token& stop) noexcept;

  SearchEvaluator& evaluator_;
  AskingOptions options_;
  TripleBuffer<Question> questions_;
  TripleBuffer<Reply> replies_;
  std::atomic<std::uint64_t> answered_{0};
  std::jthread thread_;
};

}  // namespace depthgrid::search
