#include "depthgrid/grid/map/parallel_for.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace depthgrid::grid {
namespace {

class Pieces {
 public:
  Pieces(std::size_t count, const std::function<void(std::size_t)>& work) : count_(count), work_(work) {}

  void work_until_done() noexcept {
    std::size_t piece = 0;
    while (take(piece)) {
      std::exception_ptr error;
      try {
        work_(piece);
      } catch (...) {
        error = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      if (error != nullptr) {
        error_ = error;
        next_ = count_;
      }
      ++finished_;
      changed_.notify_one();
    }
  }

  void stop() noexcept {
    const std::lock_guard lock(mutex_);
    next_ = count_;
  }

  /// Waits a moment; the number of finished pieces, and whether none is left to wait for.
  std::size_t wait(bool& over) {
    std::unique_lock lock(mutex_);
    over = changed_.wait_for(lock, std::chrono::milliseconds(100),
                             [this] { return next_ == count_ && finished_ == taken_; });
    return finished_;
  }

  [[nodiscard]] std::exception_ptr error() const noexcept { return error_; }

 private:
  bool take(std::size_t& piece) noexcept {
    const std::lock_guard lock(mutex_);
    if (next_ == count_) {
      return false;
    }
    piece = next_++;
    ++taken_;
    return true;
  }

  const std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;
  std::size_t taken_ = 0;
  std::size_t finished_ = 0;
  std::exception_ptr error_;
};

// Joins its threads whatever happens; without a call of stop() they first finish all pieces.
class Workers {
 public:
  Workers(Pieces& pieces, unsigned count) : pieces_(pieces) {
    threads_.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
      try {
        threads_.emplace_back([&pieces] { pieces.work_until_done(); });
      } catch (const std::system_error&) {
        if (threads_.empty()) {
          throw;
        }
        break;  // fewer threads do the same work
      }
    }
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  Workers(Workers&&) = delete;
  Workers& operator=(Workers&&) = delete;
  ~Workers() {
    pieces_.stop();
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }

 private:
  Pieces& pieces_;
  std::vector<std::thread> threads_;
};

}  // namespace

bool parallel_for(std::size_t pieces, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<bool(std::size_t)>& report) {
  const unsigned wanted = threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency();
  Pieces shared(pieces, work);
  std::size_t done = 0;
  {
    const Workers workers(shared, std::max(1U, wanted));
    bool over = pieces == 0;
    while (!over) {
      done = shared.wait(over);
      if (report && !report(done)) {
        return false;
      }
    }
  }
  if (shared.error() != nullptr) {
    std::rethrow_exception(shared.error());
  }
  return done == pieces;
}

}  // namespace depthgrid::grid
