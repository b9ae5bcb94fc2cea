// What the campaign says: table, claims and pictures.
#pragma once

#include "lab/experiments/campaign/campaign.hpp"

namespace depthgrid::experiments {

/// Runs the scenes without a person and with a hand against a plate as well.
void report_campaign(const CampaignPlan& plan, const CampaignState& state, ExperimentReport& report);

}  // namespace depthgrid::experiments
