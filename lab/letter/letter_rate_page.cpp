#include "lab/letter/letter_rate_page.hpp"

#include <algorithm>
#include <sstream>

#include "depthgrid/files/text_file.hpp"
#include "report/machine.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {
namespace {

const RateRow* find(std::span<const RateRow> rows, const std::string& name, int cameras) {
  for (const RateRow& row : rows) {
    if (row.name == name && row.cameras == cameras) {
      return &row;
    }
  }
  return nullptr;
}

double milliseconds_at(const RateRow& row, double q) { return 1e3 * report::quantile(row.evaluation_s, q); }

constexpr const char* kMadeBy = R"(# Speed of the grid evaluators

Made by `build/release/bin/depthgrid-lab letter rate --page docs/benchmark.md --plot docs/images/letter-rate.png`.

Workload W: a room of 6.6 x 6.6 m with a table, five boxes, an arm of 7 capsules and two people of 17 capsules each, all
moving, seen by up to eight cameras of 640 x 480 pixels around it; robot pixels masked; )";
constexpr const char* kIntroduction = R"( frame sets at 30 Hz. Nine control
points along the arm, drawn anew for every evaluation; rho = 0.4 m; cells of 1 cm, 640 x 480 x 343 of them, from 0.2882 m;
closed form of the depth grid map; ideal sensor. `letter` scans the printed window (8)-(9), `corrected` the exact one, which
has about four times as many pixels with `hybrid`.

One evaluation is all nine points. Times are CPU time of the one thread that is used. Pixels and cells are principal pixels
visited and cells checked with the other cameras, for all nine points. Gray is the share of the visited pixels whose distance
depends on the other cameras. A frame set is all cameras' images, from 16-bit to ready.

)";

}  // namespace

std::string rate_table_head() {
  return "| method | cameras | evaluations/s | ms: median / 99 % / max | ms a frame set | pixels | cells | gray | "
         "distance mm: 10 / 50 / 90 % |\n|---|---|---|---|---|---|---|---|---|\n";
}

std::string rate_table_row(const RateRow& row) {
  using report::fixed;
  const auto n = static_cast<double>(std::max<std::size_t>(row.evaluation_s.size(), 1));
  const auto distance_mm = [&row](double q) { return fixed(1e3 * report::quantile(row.distances_m, q)); };
  return "| " + row.name + " | " + std::to_string(row.cameras) + " | " + fixed(row.rate()) + " | " +
         fixed(milliseconds_at(row, 0.5), 2) + " / " + fixed(milliseconds_at(row, 0.99), 2) + " / " +
         fixed(milliseconds_at(row, 1), 2) + " | " + fixed(1e3 * report::quantile(row.update_s, 0.5), 2) + " | " +
         fixed(static_cast<double>(row.count.pixels) / n) + " | " + fixed(static_cast<double>(row.count.cells) / n) +
         " | " +
         report::percent_of(static_cast<double>(row.count.gray_pixels), static_cast<double>(row.count.pixels), 0) +
         " | " + distance_mm(0.1) + " / " + distance_mm(0.5) + " / " + distance_mm(0.9) + " |\n";
}

void draw_rate_plot(const std::string& file, std::span<const RateRow> rows) {
  report::Plot plot{"Nine control points, 640 x 480, one core", "cameras", "ms an evaluation (median)", true, true, {}};
  for (const RateRow& row : rows) {
    if (plot.series.empty() || plot.series.back().label != row.name) {
      plot.series.push_back({row.name, {}, {}, true});
    }
    plot.series.back().x.push_back(row.cameras);
    plot.series.back().y.push_back(milliseconds_at(row, 0.5));
  }
  report::Canvas canvas(900, 560);
  report::draw_plot(canvas, {0, 0, 900, 560}, plot);
  canvas.save_png(file);
}

void write_rate_page(const std::string& file, std::span<const RateRow> rows, int frame_sets) {
  std::ostringstream page;
  page << kMadeBy << frame_sets << kIntroduction << report::machine_line() << "\n\n" << rate_table_head();
  for (const RateRow& row : rows) {
    page << rate_table_row(row);
  }
  page << "\n![time against the number of cameras](images/letter-rate.png)\n\n";
  page.precision(3);
  const RateRow* two = find(rows, "letter, hybrid", 2);
  if (two != nullptr) {
    page << "- The goal of 300 evaluations a second for `letter` with the hybrid vector and two cameras, the rate that "
            "the "
            "letter states for its whole algorithm, is "
         << (two->rate() >= 300 ? "met" : "missed") << ": " << static_cast<int>(two->rate()) << " a second.\n";
    const RateRow* one = find(rows, "letter, hybrid", 1);
    if (one != nullptr) {
      const double pixels_ms = milliseconds_at(*one, 0.5);
      const double cells_ms = milliseconds_at(*two, 0.5) - pixels_ms;
      const double cells = static_cast<double>(two->count.cells) / static_cast<double>(two->evaluation_s.size()) -
                           static_cast<double>(one->count.cells) / static_cast<double>(one->evaluation_s.size());
      page << "\n- Where its time goes (medians): " << pixels_ms
           << " ms visit the pixels, what one camera alone takes; " << cells_ms << " ms judge " << cells / 1e6
           << " million cells with the other camera, " << 1e6 * cells_ms / cells
           << " ns a cell. `letter, minimum` visits fewer of both and reaches "
           << static_cast<int>(find(rows, "letter, minimum", 2) != nullptr ? find(rows, "letter, minimum", 2)->rate()
                                                                           : 0)
           << " a second.\n\n- The clock of a shared machine varies: compare the rows of one run with each other, not "
              "runs.\n";
    }
  }
  for (const char* name : {"letter, hybrid", "letter, minimum", "corrected, hybrid", "corrected, minimum"}) {
    const RateRow* few = find(rows, name, 2);
    const RateRow* many = find(rows, name, 8);
    if (few != nullptr && many != nullptr) {
      page << "\n- " << name << ": 8 cameras take " << few->rate() / many->rate()
           << " times the time of 2, for 7 times the secondary cameras.\n";
    }
  }
  files::write_text_file(file, page.str());
}

std::string broken_ratio(std::span<const RateRow> rows) {
  const auto cells = [](const RateRow& row) {
    return static_cast<double>(row.count.cells) /
           static_cast<double>(std::max<std::size_t>(row.evaluation_s.size(), 1));
  };
  for (const RateRow& row : rows) {
    const std::string method = row.name.substr(0, row.name.find(','));
    const RateRow* hybrid = find(rows, method + ", hybrid", row.cameras);
    if (hybrid != nullptr && hybrid != &row && cells(row) * 1.2 > cells(*hybrid)) {
      return row.name + " with " + std::to_string(row.cameras) + " cameras does not save a sixth of the hybrid's cells";
    }
    const RateRow* few = find(rows, row.name, 2);
    if (few != nullptr && row.cameras > 2 && row.name == "letter, hybrid" &&
        cells(row) > 1.1 * (row.cameras - 1) * cells(*few)) {
      return row.name + ": cells grow faster than the number of secondary cameras";
    }
  }
  return {};
}

}  // namespace depthgrid::lab
