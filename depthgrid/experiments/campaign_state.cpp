#include "depthgrid/experiments/campaign_state.hpp"

#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/input/file_replacement.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

/// JSON knows no infinity.
ordered_json finite(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

double number(const ordered_json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

ContactCause cause(const std::string& name) {
  for (const ContactCause one : kContactCauses) {
    if (to_string(one) == name) {
      return one;
    }
  }
  fail("'", name, "' is no cause of a contact");
}

ordered_json to_json(const Contact& contact) {
  return {{"time_s", contact.time_s},
          {"link", contact.link},
          {"robot_m_s", contact.robot_m_s},
          {"person_m_s", contact.person_m_s},
          {"told_m", contact.told_m ? ordered_json(*contact.told_m) : ordered_json(nullptr)},
          {"really_m", contact.really_m},
          {"fastest_during_m_s",
           contact.fastest_during_m_s ? ordered_json(*contact.fastest_during_m_s) : ordered_json(nullptr)},
          {"cause", to_string(contact.cause)}};
}

Contact contact_of(const ordered_json& json) {
  Contact contact;
  contact.time_s = json.at("time_s");
  contact.link = json.at("link");
  contact.robot_m_s = json.at("robot_m_s");
  contact.person_m_s = json.at("person_m_s");
  if (!json.at("told_m").is_null()) {
    contact.told_m = json.at("told_m").get<double>();
  }
  contact.really_m = json.at("really_m");
  if (!json.at("fastest_during_m_s").is_null()) {
    contact.fastest_during_m_s = json.at("fastest_during_m_s").get<double>();
  }
  contact.cause = cause(json.at("cause"));
  return contact;
}

ordered_json to_json(const RunSummary& run) {
  ordered_json json{{"task_share", run.task_share},
                    {"smallest_person_m", finite(run.smallest_person_m)},
                    {"in_contact_s", run.in_contact_s},
                    {"stopped_s", run.stopped_s},
                    {"false_stop_s", run.false_stop_s},
                    {"over_estimates", run.over_estimates},
                    {"largest_over_estimate_m", run.largest_over_estimate_m},
                    {"compared", run.compared},
                    {"object_contacts", run.object_contacts}};
  json["contacts"] = ordered_json::array();
  for (const Contact& contact : run.contacts) {
    json["contacts"].push_back(to_json(contact));
  }
  return json;
}

RunSummary summary_from(const ordered_json& json) {
  RunSummary run;
  run.task_share = json.at("task_share");
  run.smallest_person_m = number(json.at("smallest_person_m"));
  run.in_contact_s = json.at("in_contact_s");
  run.stopped_s = json.at("stopped_s");
  run.false_stop_s = json.at("false_stop_s");
  run.over_estimates = json.at("over_estimates");
  run.largest_over_estimate_m = json.at("largest_over_estimate_m");
  run.compared = json.at("compared");
  run.object_contacts = json.at("object_contacts");
  for (const ordered_json& contact : json.at("contacts")) {
    run.contacts.push_back(contact_of(contact));
  }
  return run;
}

}  // namespace

RunSummary summary_of(const RunResult& result) {
  return {result.task_share,
          result.smallest_person_m,
          result.in_contact_s,
          result.stopped_s,
          result.false_stop_s,
          result.over_estimates,
          result.largest_over_estimate_m,
          result.compared,
          result.object_contacts,
          result.contacts};
}

void write_campaign_state(const fs::path& file, const CampaignState& state) {
  ordered_json json;
  json["campaign"] = state.settings;
  json["motions"] = ordered_json::array();
  for (const auto& [number, outcome] : state.motions) {
    ordered_json entry{{"number", number}, {"name", outcome.name}, {"v_max_m_s", outcome.v_max_m_s}};
    for (const auto& [method, run] : outcome.runs) {
      entry["runs"][std::string(key(method))] = to_json(run);
    }
    json["motions"].push_back(std::move(entry));
  }
  const std::string text = json.dump(1) + "\n";
  input::FileReplacement replacement(file);
  if (std::fwrite(text.data(), 1, text.size(), replacement.stream()) != text.size()) {
    fail("cannot write ", file.string(), ": ", std::generic_category().message(errno));
  }
  replacement.commit();
}

CampaignState read_campaign_state(const fs::path& file, const ordered_json& settings) {
  CampaignState state;
  state.settings = settings;
  std::error_code error;
  if (!fs::exists(file, error)) {
    return state;
  }
  std::ifstream in(file);
  const ordered_json json = ordered_json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("campaign") || !json.contains("motions")) {
    fail(file.string(), ": is no state of a campaign; remove it, or give another --out");
  }
  if (json["campaign"] != settings) {
    fail(file.string(), ": belongs to a campaign with ", json["campaign"].dump(), ", not ", settings.dump(),
         "; give another --out");
  }
  try {
    for (const ordered_json& entry : json["motions"]) {
      MotionOutcome outcome{entry.at("name"), entry.at("v_max_m_s"), {}};
      for (const Method method : kMethods) {
        outcome.runs[method] = summary_from(entry.at("runs").at(std::string(key(method))));
      }
      state.motions[entry.at("number")] = std::move(outcome);
    }
  } catch (const nlohmann::json::exception& e) {
    fail(file.string(), ": is no state of a campaign: ", e.what());
  }
  return state;
}

}  // namespace depthgrid::experiments
