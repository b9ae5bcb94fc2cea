#include "world/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

constexpr int kInstants = 5;
constexpr int kAlong = 24;
constexpr int kAround = 96;
constexpr double kLongestWay_m = 1;  ///< no Sight leads farther into a layer in these worlds

/// Evenly spread over the sphere.
Vector3d spread(int i) {
  const double z = 1 - (2.0 * i + 1) / kAround;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// An instant of an exposure at which some of a thing was in the layer of these links. `axis`: the thing's then,
/// without radius; of what stands still nothing.
struct Contact {
  Capsule axis;
  std::vector<Capsule> links;
  double blind_m = 0;
  const Sight* sight = nullptr;  ///< null: none

  [[nodiscard]] bool holds(const Vector3d& at) const {
    const Capsule way = sight != nullptr ? sight->way(at) : Capsule::point(at);
    return std::any_of(links.begin(), links.end(), [&](const Capsule& link) { return gap_m(link, way) <= blind_m; });
  }
};

/// Looks for points of one thing that are nearer than the answer and were outside of the layer.
class Search {
 public:
  Search(const Capsule& asked, std::vector<Contact> contacts, double& least_m)
      : asked_(asked), contacts_(std::move(contacts)), least_m_(least_m) {}

  /// A point that is `part` of the way along the axis, and `offset` from there; it is `at` now.
  void try_point(double part, const Vector3d& offset, const Vector3d& at) {
    const double nearest_m = std::max(0.0, gap_m(asked_, at));
    if (nearest_m < least_m_ && !in_layer(part, offset)) {
      least_m_ = nearest_m;
    }
  }

  /// Whether nothing much nearer can be found in something that is this far away.
  [[nodiscard]] bool settled(double gap_m) const { return least_m_ <= std::max(0.0, gap_m) + 1e-4; }

 private:
  [[nodiscard]] bool in_layer(double part, const Vector3d& offset) {
    const auto holds = [&](const Contact& contact) {
      return contact.holds(contact.axis.a + part * (contact.axis.b - contact.axis.a) + offset);
    };
    const auto found = std::find_if(contacts_.begin(), contacts_.end(), holds);
    if (found == contacts_.end()) {
      return false;
    }
    std::iter_swap(contacts_.begin(), found);  // most likely it holds the next point as well
    return true;
  }

  const Capsule& asked_;
  std::vector<Contact> contacts_;
  double& least_m_;
};

/// from_s: since when the thing is there. axis_at(time): a thing's; touches(link, time, blind): whether some of the
/// thing is in the link's layer then.
template <class AxisAt, class Touches>
std::vector<Contact> contacts_of(std::span<const Look> looks, double blind_m, double from_s, const AxisAt& axis_at,
                                 const Touches& touches) {
  std::vector<Contact> contacts;
  contacts.reserve(kInstants * looks.size());
  for (const Look& look : looks) {
    const double layer_m = std::max(blind_m, look.blind_m);
    for (int i = 0; i < kInstants && layer_m > 0 && !look.robot.empty(); ++i) {
      const double time_s = look.from_s + (look.to_s - look.from_s) * i / (kInstants - 1);
      if (time_s < from_s) {
        continue;
      }
      Contact contact{axis_at(time_s), {}, layer_m, look.sight ? &*look.sight : nullptr};
      contact.links.reserve(look.robot.size());
      std::copy_if(look.robot.begin(), look.robot.end(), std::back_inserter(contact.links), [&](const Capsule& link) {
        return touches(link, contact.axis, contact.blind_m + (look.sight ? kLongestWay_m : 0.0));
      });
      if (!contact.links.empty()) {
        contacts.push_back(std::move(contact));
      }
    }
  }
  return contacts;
}

void try_solid(const Solid& solid, const Capsule& asked, double time_s, double blind_m, std::span<const Look> looks,
               double& least_m) {
  const Capsule now = solid.at(time_s);
  const double gap = gap_m(asked, now);
  Search search(
      asked,
      contacts_of(
          looks, blind_m, solid.from_s, [&solid](double at_s) { return solid.at(at_s); },
          [](const Capsule& link, const Capsule& thing, double layer_m) { return gap_m(link, thing) <= layer_m; }),
      least_m);
  for (int along = 0; along <= kAlong && !search.settled(gap); ++along) {
    const double part = static_cast<double>(along) / kAlong;
    const Vector3d axis = now.a + part * (now.b - now.a);
    const Vector3d towards = nearest_on_axis(asked, axis) - axis;
    if (towards.norm() > 0) {
      const Vector3d offset = now.radius_m * towards.normalized();
      search.try_point(part, offset, axis + offset);
    }
    search.try_point(part, Vector3d::Zero(), axis);
    for (int i = 0; i < 4 * kAround && !search.settled(gap); ++i) {
      const Vector3d offset = 0.25 * (1 + i / kAround) * now.radius_m * spread(i % kAround);
      search.try_point(part, offset, axis + offset);
    }
  }
}

void try_wall(const HalfSpace& wall, const Capsule& asked, double answer_m, double blind_m, std::span<const Look> looks,
              double& least_m) {
  Search search(asked,
                contacts_of(
                    looks, blind_m, -std::numeric_limits<double>::infinity(), [](double /*at_s*/) { return Capsule{}; },
                    [&wall](const Capsule& link, const Capsule& /*thing*/, double layer_m) {
                      return gap_m(link, wall) <= layer_m;
                    }),
                least_m);
  const double gap = gap_m(asked, wall);
  for (int along = 0; along <= kAlong && !search.settled(gap); ++along) {
    const Vector3d axis = asked.a + static_cast<double>(along) / kAlong * (asked.b - asked.a);
    const Vector3d foot = axis - (wall.normal.dot(axis) - wall.offset_m) * wall.normal;
    search.try_point(0, foot, foot);
    for (int i = 0; i < 4 * kAround && !search.settled(gap); ++i) {
      Vector3d at = foot + 0.25 * (1 + i / kAround) * (answer_m + asked.radius_m) * spread(i % kAround);
      at -= std::max(0.0, wall.normal.dot(at) - wall.offset_m) * wall.normal;
      search.try_point(0, at, at);
    }
  }
}

}  // namespace

Capsule Sight::way(const Vector3d& at) const {
  const double depth_m = axis_world.dot(at - centre_world);
  if (!(depth_m > 0)) {
    return Capsule::point(at);
  }
  double reading_m = depth_m;
  for (int i = 0; i < 50; ++i) {
    reading_m = depth_m + depth_margin_m(sensor, reading_m);
  }
  const double way = std::min(2 * (reading_m - depth_m) / depth_m, kLongestWay_m / (at - centre_world).norm());
  return {at, at + way * (at - centre_world), 0};
}

Verdict judge(const World& world, const Capsule& asked, double answer_m, double time_s, double blind_m,
              std::span<const Look> looks) {
  Verdict verdict;
  verdict.truth_m = true_distance_m(world, asked, time_s);
  if (!(answer_m > verdict.truth_m)) {
    return verdict;
  }
  double least_m = answer_m;
  // Without a known layer nothing is exempt.
  const std::span<const Look> counted = blind_m >= 0 ? looks : std::span<const Look>();
  for (const Solid& solid : world.solids) {
    if (solid.exists(time_s) && gap_m(asked, solid.at(time_s)) < least_m) {
      try_solid(solid, asked, time_s, blind_m, counted, least_m);
    }
  }
  for (const HalfSpace& wall : world.walls) {
    if (gap_m(asked, wall) < least_m) {
      try_wall(wall, asked, answer_m, blind_m, counted, least_m);
    }
  }
  if (least_m < answer_m) {
    verdict.excess_m = answer_m - least_m;
  } else {
    verdict.in_layer = true;
  }
  return verdict;
}

}  // namespace depthgrid::world
