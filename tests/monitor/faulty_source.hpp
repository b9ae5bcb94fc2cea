// Sources with faults that a test switches on and off while they run.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::test {

enum class Fault : std::uint8_t {
  none,
  drop,         ///< no image comes
  delay,        ///< each comes half a second late
  freeze,       ///< the same pixels with new times
  reorder,      ///< every second one comes after the next
  duplicate,    ///< each comes twice
  black,        ///< no pixel has a reading
  wrong_size,   ///< half as high
  wrong_clock,  ///< an hour ahead
  slow_clock,   ///< an hour behind
  unplug,       ///< next() fails, and open() too
  restart,      ///< next() fails once; then it is opened again
};

inline constexpr Fault kFaults[] = {Fault::drop,       Fault::delay,  Fault::freeze,     Fault::reorder,
                                    Fault::duplicate,  Fault::black,  Fault::wrong_size, Fault::wrong_clock,
                                    Fault::slow_clock, Fault::unplug, Fault::restart};

inline const char* name_of(Fault fault) {
  constexpr const char* kNames[] = {"none",  "drop",       "delay",       "freeze",     "reorder", "duplicate",
                                    "black", "wrong size", "wrong clock", "slow clock", "unplug",  "restart"};
  return kNames[static_cast<std::size_t>(fault)];
}

/// Passes on what another source gives, 16-bit images without padding, unless a fault is set.
class FaultyCamera final : public sensors::DepthSource {
 public:
  FaultyCamera(std::unique_ptr<sensors::DepthSource> source, const std::atomic<Fault>& fault)
      : source_(std::move(source)), fault_(fault) {}

  void open() override {
    if (fault_ == Fault::unplug) {
      fail("no such device");
    }
    source_->open();
    restarted_ = fault_ == Fault::restart;
    held_.clear();
  }
  void close() noexcept override { source_->close(); }
  [[nodiscard]] const sensors::SourceInfo& info() const noexcept override { return source_->info(); }
  [[nodiscard]] std::string_view reason() const noexcept override { return "the cable was pulled"; }

  [[nodiscard]] sensors::Reading next(sensors::DepthReading& reading, double longest_s) noexcept override {
    const Fault fault = fault_;
    restarted_ = restarted_ && fault == Fault::restart;
    if (fault == Fault::unplug || (fault == Fault::restart && !restarted_)) {
      return sensors::Reading::failed;
    }
    if (fault == Fault::duplicate && has_last_ && !doubled_) {
      doubled_ = true;
      reading = view(last_);
      return sensors::Reading::got;
    }
    doubled_ = false;
    if (fault != Fault::delay && fault != Fault::reorder) {
      held_.clear();
    }
    const sensors::Reading result = source_->next(reading, longest_s);
    if (result != sensors::Reading::got) {
      return result;
    }
    return with(fault, reading);
  }

 private:
  struct Image {
    std::vector<std::uint16_t> units;
    sensors::DepthReading reading;
  };

  sensors::DepthReading view(const Image& image) {
    given_ = image;
    sensors::DepthReading reading = given_.reading;
    reading.depth.data = given_.units.data();
    return reading;
  }
  static Image copied(const sensors::DepthReading& reading) {
    const auto* units = static_cast<const std::uint16_t*>(reading.depth.data);
    return {{units, units + static_cast<std::ptrdiff_t>(reading.depth.width_px) * reading.depth.height_px}, reading};
  }

  sensors::Reading with(Fault fault, sensors::DepthReading& reading) {
    Image image = copied(reading);
    constexpr double kHour_s = 3600;
    constexpr double kDelay_s = 0.5;
    switch (fault) {
      case Fault::drop:
        return sensors::Reading::nothing;
      case Fault::delay:
        held_.push_back(image);
        if (held_.front().reading.time_s > sensors::clock_now_s() - kDelay_s) {
          return sensors::Reading::nothing;
        }
        reading = view(held_.front());
        held_.pop_front();
        return sensors::Reading::got;
      case Fault::freeze:
        if (has_last_) {
          image.units = last_.units;
        }
        break;
      case Fault::reorder:
        held_.push_back(image);
        if (held_.size() < 2) {
          return sensors::Reading::nothing;
        }
        if (held_.size() == 2) {
          reading = view(held_.back());
          return sensors::Reading::got;
        }
        reading = view(held_.front());
        held_.clear();
        return sensors::Reading::got;
      case Fault::black:
        image.units.assign(image.units.size(), 0);
        break;
      case Fault::wrong_size:
        image.reading.depth.height_px /= 2;
        break;
      case Fault::wrong_clock:
        image.reading.time_s += kHour_s;
        break;
      case Fault::slow_clock:
        image.reading.time_s -= kHour_s;
        break;
      default:
        break;
    }
    if (fault != Fault::freeze || !has_last_) {
      last_ = image;
      has_last_ = true;
    }
    reading = view(image);
    return sensors::Reading::got;
  }

  std::unique_ptr<sensors::DepthSource> source_;
  const std::atomic<Fault>& fault_;
  std::deque<Image> held_;
  Image last_;
  Image given_;
  bool has_last_ = false;
  bool doubled_ = false;
  bool restarted_ = false;
};

/// The same of joints: drop, wrong_clock, unplug and restart.
class FaultyJoints final : public sensors::JointSource {
 public:
  FaultyJoints(std::unique_ptr<sensors::JointSource> source, const std::atomic<Fault>& fault)
      : source_(std::move(source)), fault_(fault) {}

  void open() override {
    if (fault_ == Fault::unplug) {
      fail("no such robot");
    }
    source_->open();
  }
  void close() noexcept override { source_->close(); }
  [[nodiscard]] const sensors::SourceInfo& info() const noexcept override { return source_->info(); }
  [[nodiscard]] std::string_view reason() const noexcept override { return "the robot is off"; }
  [[nodiscard]] sensors::Reading next(sensors::JointReading& reading, double longest_s) noexcept override {
    const Fault fault = fault_;
    if (fault == Fault::unplug) {
      return sensors::Reading::failed;
    }
    const sensors::Reading result = source_->next(reading, longest_s);
    if (fault == Fault::wrong_clock) {
      reading.time_s += 3600;
    }
    return fault == Fault::drop && result == sensors::Reading::got ? sensors::Reading::nothing : result;
  }

 private:
  std::unique_ptr<sensors::JointSource> source_;
  const std::atomic<Fault>& fault_;
};

}  // namespace depthgrid::test
