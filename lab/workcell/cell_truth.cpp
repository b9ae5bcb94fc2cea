#include "lab/workcell/cell_truth.hpp"

#include <algorithm>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/workcell/fcl_parts.hpp"

namespace depthgrid::workcell {

using simulation::BodyKind;
using simulation::Plane;
using simulation::Workcell;
using simulation::WorkcellBody;

namespace {

struct TruthBody {
  BodyKind kind = BodyKind::object;
  std::vector<Part> parts;
  std::vector<Plane> planes_world;
};

bool one_of(BodyKind kind, std::initializer_list<BodyKind> kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

struct CellTruth::Impl {
  explicit Impl(const Workcell& given) : cell((validate(given), given)), bodies(given.bodies.size()) { refresh(); }

  void refresh() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const WorkcellBody& body = cell.bodies[i];
      bodies[i].kind = body.kind;
      bodies[i].parts = parts_of(body, std::move(bodies[i].parts));
      bodies[i].planes_world.clear();
      for (const Plane& plane : body.planes) {
        bodies[i].planes_world.push_back(transformed(body.T_world_body, plane));
      }
    }
  }

  /// Lowers `best` where these two bodies are nearer.
  void consider(std::size_t first, std::size_t second, std::optional<BodyDistance>& best) const;

  Workcell cell;
  std::vector<TruthBody> bodies;
};

void CellTruth::Impl::consider(std::size_t first, std::size_t second, std::optional<BodyDistance>& best) const {
  const auto take = [first, second, &best](const PartDistance& found, bool swapped) {
    if (best && found.distance_m >= best->distance_m) {
      return;
    }
    BodyDistance& nearest = best.emplace();
    nearest.first = first;
    nearest.second = second;
    nearest.distance_m = found.distance_m;
    if (found.distance_m > 0) {
      nearest.on_first_world = swapped ? found.on_second_world : found.on_first_world;
      nearest.on_second_world = swapped ? found.on_first_world : found.on_second_world;
    }
  };
  const TruthBody& a = bodies[first];
  const TruthBody& b = bodies[second];
  for (const Part& p : a.parts) {
    for (const Part& q : b.parts) {
      if (!best || least_distance_m(p, q) < best->distance_m) {
        take(distance(p, q), false);
      }
    }
    for (const Plane& plane : b.planes_world) {
      take(distance(p, plane), false);
    }
  }
  for (const Plane& plane : a.planes_world) {
    for (const Part& q : b.parts) {
      take(distance(q, plane), true);
    }
  }
}

CellTruth::CellTruth(const Workcell& cell) : impl_(std::make_unique<Impl>(cell)) {}
CellTruth::~CellTruth() = default;
CellTruth::CellTruth(CellTruth&& other) noexcept = default;
CellTruth& CellTruth::operator=(CellTruth&& other) noexcept = default;

void CellTruth::update(const Workcell& cell) {
  validate_same_bodies(impl_->cell, cell);
  impl_->cell = cell;
  impl_->refresh();
}

std::optional<BodyDistance> CellTruth::between(std::size_t first, std::size_t second) const {
  const std::size_t bodies = impl_->bodies.size();
  if (first >= bodies || second >= bodies || first == second) {
    fail("distance between bodies ", first, " and ", second, ": must be two of 0 ... ", bodies - 1);
  }
  std::optional<BodyDistance> best;
  impl_->consider(first, second, best);
  return best;
}

std::optional<BodyDistance> CellTruth::nearest(BodyKind of, std::initializer_list<BodyKind> to) const {
  std::optional<BodyDistance> best;
  for (std::size_t i = 0; i < impl_->bodies.size(); ++i) {
    if (impl_->bodies[i].kind == of) {
      for (std::size_t j = 0; j < impl_->bodies.size(); ++j) {
        if (j != i && one_of(impl_->bodies[j].kind, to)) {
          impl_->consider(i, j, best);
        }
      }
    }
  }
  return best;
}

std::optional<BodyDistance> CellTruth::nearest(std::size_t body, std::initializer_list<BodyKind> to) const {
  if (body >= impl_->bodies.size()) {
    fail("there is no body ", body, ", must be below ", impl_->bodies.size());
  }
  std::optional<BodyDistance> best;
  for (std::size_t j = 0; j < impl_->bodies.size(); ++j) {
    if (j != body && one_of(impl_->bodies[j].kind, to)) {
      impl_->consider(body, j, best);
    }
  }
  return best;
}

}  // namespace depthgrid::workcell
