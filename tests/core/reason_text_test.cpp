// What is nearest, in words.
#include "depthgrid/core/reason_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace depthgrid {
namespace {

std::string words(ProximityState state, Unmeasured why = Unmeasured::not_told, const Past& past = {}) {
  Proximity nearest;
  nearest.state = state;
  nearest.unmeasured = why;
  std::array<char, 240> buffer{};
  return std::string(reason_text(nearest, past, 10, buffer));
}

TEST(ReasonText, SaysWhatIsNearest) {
  EXPECT_EQ(words(ProximityState::measured), "a surface");
  EXPECT_EQ(words(ProximityState::occluded), "space hidden behind a surface");
  EXPECT_EQ(words(ProximityState::unmeasured), "space without a reading");
  EXPECT_EQ(words(ProximityState::unmeasured, Unmeasured::no_reading), "space without a reading");
  EXPECT_EQ(words(ProximityState::unmeasured, Unmeasured::image_edge), "space at the edge of a camera's image");
  EXPECT_EQ(words(ProximityState::unmeasured, Unmeasured::blind_zone), "space too near to a camera for it to measure");
  EXPECT_EQ(words(ProximityState::unmeasured, Unmeasured::late_image),
            "space that only a camera without new images looks at");
  EXPECT_EQ(words(ProximityState::unobserved), "space that no camera looks at");
  EXPECT_EQ(words(ProximityState::outside), "the border of the space of interest");
  EXPECT_EQ(words(ProximityState::beyond_rho), "anything that may be there");
  EXPECT_EQ(to_string(Unmeasured::blind_zone), "blind_zone");
}

TEST(ReasonText, SaysSinceWhenAndFromWhere) {
  Past past;
  past.state = PastState::never_ruled_out;
  EXPECT_EQ(words(ProximityState::occluded, {}, past), "space hidden behind a surface, never seen free");
  past.state = PastState::not_kept;
  EXPECT_EQ(words(ProximityState::occluded, {}, past), "space hidden behind a surface, outside of what is remembered");
  past.state = PastState::ruled_out;
  EXPECT_EQ(words(ProximityState::unobserved, {}, past), "space that no camera looks at, seen free by now");
  past.state = PastState::possible_again;
  past.possible_since_s = 9.25;
  EXPECT_EQ(words(ProximityState::occluded, {}, past),
            "space hidden behind a surface, where nothing could be until 0.75 s ago");
  past.from_m = 0.412;
  past.origin = PastOrigin::never_ruled_out;
  EXPECT_EQ(words(ProximityState::occluded, {}, past),
            "space hidden behind a surface, where nothing could be until 0.75 s ago, then something from space never "
            "seen free 0.412 m from there");
  past.origin = PastOrigin::not_kept;
  EXPECT_TRUE(words(ProximityState::occluded, {}, past)
                  .ends_with("then something over the border of what is remembered 0.412 m from there"));
  past.origin = PastOrigin::earlier;
  EXPECT_TRUE(
      words(ProximityState::occluded, {}, past).ends_with("then something that may have been 0.412 m from there"));
  EXPECT_EQ(to_string(PastState::possible_again), "possible_again");
  std::array<char, 5> small{};
  EXPECT_EQ(reason_text(Proximity{}, past, 10, small), "anyth");
}

}  // namespace
}  // namespace depthgrid
