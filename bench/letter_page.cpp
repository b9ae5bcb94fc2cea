#include "letter_page.hpp"

#include <rapidjson/ostreamwrapper.h>
#include <rapidjson/prettywriter.h>

#include <algorithm>
#include <cstdio>
#include <functional>

namespace depthgrid::bench {
namespace {

/// Quantiles of one kind of error over all decided points of a campaign, metres.
struct Spread {
  std::size_t count = 0;
  double median_m = 0, q95_m = 0, q99_m = 0, largest_m = 0;
  double share_above_1cm = 0;
};

Spread spread_of(const CampaignResult& campaign, const std::function<double(const PointErrors&)>& value) {
  std::vector<double> values_m;
  for (const PointErrors& point : campaign.points) {
    values_m.push_back(value(point));
  }
  Spread result;
  result.count = values_m.size();
  if (values_m.empty()) {
    return result;
  }
  std::sort(values_m.begin(), values_m.end());
  const auto at = [&](double share) {
    return values_m[static_cast<std::size_t>(share * static_cast<double>(values_m.size() - 1))];
  };
  result.median_m = at(0.5);
  result.q95_m = at(0.95);
  result.q99_m = at(0.99);
  result.largest_m = values_m.back();
  const auto above =
      static_cast<double>(std::count_if(values_m.begin(), values_m.end(), [](double x) { return x > 0.01; }));
  result.share_above_1cm = above / static_cast<double>(values_m.size());
  return result;
}

std::string mm(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, metres >= 0.01 ? "%.0f" : metres >= 1e-4 ? "%.1f" : "%.0f", metres * 1000);
  return text;
}
std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share > 0 && share < 0.1 ? "%.1f %%" : "%.0f %%", share * 100);
  return text;
}

std::string images_of(const CampaignSettings& settings) {
  return settings.width_px == 0 ? "48x36 to 96x72" : "640x480";
}

void write_campaigns(const LetterErrors& errors, std::ostream& out) {
  struct Method {
    const char* name;
    std::function<PointErrors::Error(const PointErrors&)> error;
  };
  const std::vector<Method> methods{{"letter, window (8)-(9)", [](const PointErrors& p) { return p.letter_printed; }},
                                    {"letter, whole image", [](const PointErrors& p) { return p.letter_whole; }},
                                    {"corrected", [](const PointErrors& p) { return p.corrected; }}};
  for (const bool over : {true, false}) {
    out << (over ? "Over-estimates (answer - hi), millimetres:\n\n"
                 : "\nUnder-estimates (lo - answer), millimetres:\n\n")
        << "| images | secondary cameras | points | method | above 1 cm | median | 95 % | 99 % | largest |\n"
        << "|---|---|---|---|---|---|---|---|---|\n";
    for (const CampaignResult& campaign : errors.campaigns) {
      for (const Method& method : methods) {
        const Spread s = spread_of(
            campaign, [&](const PointErrors& p) { return over ? method.error(p).over_m : method.error(p).under_m; });
        out << "| " << images_of(campaign.settings) << " | " << campaign.settings.secondaries << " | " << s.count
            << " | " << method.name << " | " << percent(s.share_above_1cm) << " | " << mm(s.median_m) << " | "
            << mm(s.q95_m) << " | " << mm(s.q99_m) << " | " << mm(s.largest_m) << " |\n";
      }
    }
  }
}

void write_causes(const LetterErrors& errors, std::ostream& out) {
  const std::vector<const char*> causes{"window (8)-(9)", "order of (iii)", "clamp (5)-(7)", "surface only in (ii)",
                                        "confirmation by one pixel's d_start"};
  out << "| images | secondary cameras | cause | share above 1 cm | 99 % | largest |\n|---|---|---|---|---|---|\n";
  for (const CampaignResult& campaign : errors.campaigns) {
    for (std::size_t i = 0; i < causes.size(); ++i) {
      const Spread s = spread_of(
          campaign, [i](const PointErrors& p) { return p.over_after_mends_m[i] - p.over_after_mends_m[i + 1]; });
      out << "| " << images_of(campaign.settings) << " | " << campaign.settings.secondaries << " | " << causes[i]
          << " | " << percent(s.share_above_1cm) << " | " << mm(s.q99_m) << " | " << mm(s.largest_m) << " |\n";
    }
    const Spread rest = spread_of(campaign, [](const PointErrors& p) { return p.over_after_mends_m.back(); });
    out << "| " << images_of(campaign.settings) << " | " << campaign.settings.secondaries
        << " | left after all mends | " << percent(rest.share_above_1cm) << " | " << mm(rest.q99_m) << " | "
        << mm(rest.largest_m) << " |\n";
  }
}

void write_excess(const std::vector<Excess>& rows, std::ostream& out) {
  out << "| case | cases | median | 99 % | largest |\n|---|---|---|---|---|\n";
  for (const Excess& row : rows) {
    out << "| " << row.name << " | " << row.cases << " | " << mm(row.median_m) << " | " << mm(row.q99_m) << " | "
        << mm(row.largest_m) << " |\n";
  }
}

}  // namespace

void write_page(const LetterErrors& errors, std::ostream& out) {
  write_campaigns(errors, out);
  write_causes(errors, out);
  for (const CampaignResult& campaign : errors.campaigns) {
    const auto agree = std::count_if(campaign.points.begin(), campaign.points.end(),
                                     [](const PointErrors& p) { return p.model_agrees; });
    const auto undecided =
        std::count_if(campaign.points.begin(), campaign.points.end(), [](const PointErrors& p) { return !p.decided; });
    out << "agree " << agree << " undecided " << undecided << " of " << campaign.points.size() << "\n";
  }
  for (const WindowMiss& row : errors.window) {
    out << row.depth_m << " " << row.first_missed_m << " " << row.last_whole_m << "\n";
  }
  write_excess(errors.clamp, out);
  write_excess(errors.order, out);
  for (const Vanishing& row : errors.vanishing) {
    out << row.object << " " << row.secondaries << " " << row.point_behind << " " << row.letter << " " << row.corrected
        << " / " << row.trials << "\n";
  }
}

void write_json(const LetterErrors&, std::ostream&) {}

}  // namespace depthgrid::bench
