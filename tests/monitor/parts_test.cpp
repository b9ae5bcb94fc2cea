#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/monitor/image_check.hpp"
#include "depthgrid/monitor/json_line.hpp"
#include "depthgrid/monitor/stop_hold.hpp"
#include "depthgrid/monitor/time_histogram.hpp"

namespace depthgrid::monitor {
namespace {

using ::testing::HasSubstr;

TEST(ImageCheck, TakesWhatIsNewAndOfNow) {
  std::vector<std::uint16_t> pixels(12, 1000);
  const DepthView image = depth_view(pixels, 4, 3, 0.001);
  ImageCheck check(0.5, false);
  EXPECT_EQ(check.look(image, false, 10.0, 10.02), ImageVerdict::new_image);
  pixels[5] = 1001;
  EXPECT_EQ(check.look(image, false, 10.0, 10.03), ImageVerdict::not_newer) << "doubled";
  EXPECT_EQ(check.look(image, false, 9.9, 10.03), ImageVerdict::not_newer) << "out of order";
  EXPECT_EQ(check.look(image, false, 10.1, 10.05), ImageVerdict::from_the_future);
  EXPECT_EQ(check.look(image, false, std::nan(""), 10.05), ImageVerdict::from_the_future);
  EXPECT_EQ(check.look(image, false, 10.01, 11.0), ImageVerdict::too_old);
  EXPECT_EQ(check.look(image, false, 10.054, 10.05), ImageVerdict::new_image) << "within the clocks' tolerance";
  EXPECT_EQ(check.look(image, false, 10.2, 10.3), ImageVerdict::equal_pixels);
  EXPECT_EQ(check.look(image, true, 10.2, 10.3), ImageVerdict::new_image) << "nothing is seen, again";
  EXPECT_EQ(check.look(image, false, 10.3, 10.3), ImageVerdict::equal_pixels);
  check.begin_anew();
  EXPECT_EQ(check.look(image, false, 10.3, 10.3), ImageVerdict::new_image);
  ImageCheck tolerant(0.5, true);
  EXPECT_EQ(tolerant.look(image, false, 10.0, 10.0), ImageVerdict::new_image);
  EXPECT_EQ(tolerant.look(image, false, 10.1, 10.1), ImageVerdict::new_image);
}

TEST(ImageCheck, TheHashSeesEveryPixelAndNoPadding) {
  std::vector<std::uint16_t> pixels(7 * 6, 1000);  // rows of 5 pixels and 2 of padding
  const DepthView image = depth_view(pixels, 5, 6, 0.001, 14);
  const std::uint64_t hash = pixel_hash(image);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ++pixels[i];
    EXPECT_EQ(pixel_hash(image) == hash, i % 7 >= 5) << i;
    --pixels[i];
  }
  std::swap(pixels[0], pixels[1]);
  EXPECT_EQ(pixel_hash(image), hash);
  EXPECT_EQ(pixel_hash({}), 0U);
}

TEST(TimeHistogram, QuantilesAreWithinAStep) {
  TimeHistogram times;
  EXPECT_FALSE(times.quantile_s(0.5));
  for (int i = 1; i <= 1000; ++i) {
    times.add(1e-4 * i);
  }
  times.add(std::nan(""));
  EXPECT_EQ(times.count(), 1000U);
  EXPECT_NEAR(*times.quantile_s(0.5), 0.05, 0.05 * 0.051);
  EXPECT_GE(*times.quantile_s(0.5), 0.05);
  EXPECT_GE(*times.quantile_s(0.999), 0.0999);
  EXPECT_EQ(times.largest_s(), 0.1);
  EXPECT_EQ(*times.quantile_s(1), 0.1);
  times.add(1e9);
  times.add(0);
  times.add(-1);
  EXPECT_EQ(times.count(), 1003U);
}

TEST(EventQueue, WhatDoesNotFitIsCounted) {
  EventQueue queue;
  Event event;
  for (int i = 0; i < 100; ++i) {
    event.time_s = i;
    queue.push(event);
  }
  EXPECT_EQ(queue.dropped(), 36U);
  int count = 0;
  while (queue.pop(event)) {
    EXPECT_EQ(event.time_s, count);
    ++count;
  }
  EXPECT_EQ(count, 64);
  event.say(std::string(1000, 'x'));
  EXPECT_EQ(event.words().size(), Event::kLongest - 1);
}

TEST(EventQueue, FromOneThreadToAnother) {
  EventQueue queue;
  constexpr int kEvents = 20000;
  std::jthread writer([&] {
    Event event;
    for (int i = 1; i <= kEvents; ++i) {
      event.time_s = i;
      event.say(std::to_string(i));
      queue.push(event);
    }
  });
  double last = 0;
  int count = 0;
  Event event;
  while (last < kEvents && count + static_cast<int>(queue.dropped()) < kEvents) {
    if (queue.pop(event)) {
      EXPECT_GT(event.time_s, last);
      EXPECT_EQ(event.words(), std::to_string(static_cast<int>(event.time_s)));
      last = event.time_s;
      ++count;
    }
  }
}

Names names() { return {"cell", {"left", "right"}, {"hand", "elbow"}}; }

TEST(StopHold, AStopLastsUntilAllWasClearForAWhile) {
  StopHold hold(0.5);
  EXPECT_FALSE(hold.look(false, 10)) << "nothing was";
  EXPECT_TRUE(hold.look(true, 11));
  EXPECT_EQ(hold.clear_s(), 0);
  EXPECT_TRUE(hold.look(false, 11.25));
  EXPECT_EQ(hold.clear_s(), 0.25);
  EXPECT_TRUE(hold.look(true, 11.375)) << "again";
  EXPECT_TRUE(hold.look(false, 11.75));
  EXPECT_FALSE(hold.look(false, 11.875));
  StopHold none(0);
  EXPECT_TRUE(none.look(true, 1));
  EXPECT_FALSE(none.look(false, 1.001));
}

TEST(Sentence, NamesPartDistanceAndCamera) {
  Reason reason;
  reason.limit = avoidance::MotionLimit::obstacle;
  reason.part = 1;
  reason.distance_m = 0.25;
  reason.blind_m = 0.1;
  reason.v_max_m_s = 1.6;
  reason.reaction_s = 0.03;
  reason.stop_m = 0.2;
  reason.nearest.state = ProximityState::measured;
  reason.nearest.camera = 0;
  std::array<char, 640> buffer{};
  EXPECT_EQ(sentence(reason, names(), buffer),
            "elbow is 0.25 m from a surface seen by left; blind layer 0.1 m, what moves at 1.6 m/s for 0.03 s is taken "
            "off, limit 0.2 m beyond the layer: stops at 0.3 m");
  reason.camera = 1;
  reason.camera_state = CameraState::frozen;
  reason.camera_age_s = 0.4;
  EXPECT_THAT(std::string(sentence(reason, names(), buffer)),
              HasSubstr("; camera right repeats the same image, its image is 0.4 s old"));
  reason.limit = avoidance::MotionLimit::no_joint_state;
  reason.joints_age_s = 0.3;
  EXPECT_THAT(std::string(sentence(reason, names(), buffer)), HasSubstr("no joint state for 0.3 s"));
  reason.joints_age_s = std::nan("");
  EXPECT_THAT(std::string(sentence(reason, names(), buffer)), HasSubstr("no joint state yet"));
  std::array<char, 10> small{};
  EXPECT_EQ(sentence(reason, names(), small).size(), 10U);
}

TEST(JsonLine, HasNullForWhatIsNotKnownAndRoundsDown) {
  CellAnswer answer;
  answer.sequence = 7;
  answer.camera_count = 2;
  answer.parts.resize(2);
  answer.parts_world.resize(2);
  answer.parts[0].distance_now_m = 0.1234567;
  answer.parts[0].nearest.state = ProximityState::occluded;
  Names odd = names();
  odd.parts[1] = R"(el"b\ow)";
  const std::string line = json_line(answer, odd);
  EXPECT_THAT(line, HasSubstr(R"({"sequence":7,"time_s":null,)"));
  EXPECT_THAT(line,
              HasSubstr(R"({"part":"hand","distance_m":0.123456,"state":"occluded","nearest_m":[null,null,null]})"));
  EXPECT_THAT(line, HasSubstr(R"("part":"el\"b\\ow","distance_m":null)"));
  EXPECT_THAT(line, HasSubstr(R"("cameras":[{"camera":"left","state":"opening","age_s":null)"));
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace depthgrid::monitor
