// The page and the JSON file about the letter's errors.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "lab/letter/letter_campaign.hpp"
#include "lab/letter/letter_experiments.hpp"

namespace depthgrid::lab {

struct CampaignResult {
  CampaignSettings settings;
  std::vector<PointErrors> points;
};

struct LetterErrors {
  std::string command;  ///< that makes the page again
  std::string date;
  std::vector<CampaignResult> campaigns;
  std::vector<WindowMiss> window;
  std::vector<Excess> clamp;
  std::vector<Excess> order;
  std::vector<Vanishing> vanishing;
};

void write_page(const LetterErrors& errors, std::ostream& out);
/// Throws Error that names the file.
void write_json(const LetterErrors& errors, const std::string& file);

}  // namespace depthgrid::lab
