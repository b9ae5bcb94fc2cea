#include "lab/experiments/campaign/campaign_state.hpp"

#include <limits>
#include <optional>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

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

ordered_json to_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

std::optional<double> optional_number(const ordered_json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

ordered_json to_json(const Contact& contact) {
  return {{"time_s", contact.time_s},
          {"link", contact.link},
          {"robot_m_s", contact.robot_m_s},
          {"person_m_s", contact.person_m_s},
          {"told_m", to_json(contact.told_m)},
          {"really_m", contact.really_m},
          {"fastest_during_m_s", to_json(contact.fastest_during_m_s)},
          {"cause", to_string(contact.cause)}};
}

Contact contact_of(const ordered_json& json) {
  Contact contact;
  contact.time_s = json.at("time_s");
  contact.link = json.at("link");
  contact.robot_m_s = json.at("robot_m_s");
  contact.person_m_s = json.at("person_m_s");
  contact.told_m = optional_number(json.at("told_m"));
  contact.really_m = json.at("really_m");
  contact.fastest_during_m_s = optional_number(json.at("fastest_during_m_s"));
  contact.cause = cause(json.at("cause"));
  return contact;
}

/// What is a finite number in a summary, with its key: the same for writing and reading.
template <class Summary, class Visit>
void each_number(Summary& run, Visit visit) {
  visit("in_contact_s", run.in_contact_s);
  visit("stopped_s", run.stopped_s);
  visit("false_stop_s", run.false_stop_s);
  visit("over_estimates", run.over_estimates);
  visit("largest_over_estimate_m", run.largest_over_estimate_m);
  visit("compared", run.compared);
  visit("object_contacts", run.object_contacts);
}

ordered_json to_json(const RunSummary& run) {
  ordered_json json{{"task_share", run.task_share}, {"smallest_person_m", lab::finite(run.smallest_person_m)}};
  each_number(run, [&](const char* key, const auto& value) { json[key] = value; });
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
  each_number(run, [&](const char* key, auto& value) { json.at(key).get_to(value); });
  for (const ordered_json& contact : json.at("contacts")) {
    run.contacts.push_back(contact_of(contact));
  }
  return run;
}

/// The settings that differ, as "seed 2 instead of 1".
std::string differences(const ordered_json& has, const ordered_json& wanted) {
  const auto text = [](const ordered_json& json, const std::string& key) {
    return json.contains(key) ? json.at(key).dump() : std::string("none");
  };
  std::string result;
  for (const ordered_json* json : {&wanted, &has}) {
    for (const auto& [key, value] : json->items()) {
      const std::string line = key + " " + text(has, key) + " instead of " + text(wanted, key);
      if (text(has, key) != text(wanted, key) && result.find(line) == std::string::npos) {
        result += (result.empty() ? "" : ", ") + line;
      }
    }
  }
  return result;
}

}  // namespace

std::vector<Method> methods_of(const ordered_json& settings) {
  return settings.contains("with_memory") ? std::vector<Method>{Method::none, Method::letter_two, Method::search_memory}
                                          : std::vector<Method>(kMethods.begin(), kMethods.end());
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
  lab::write_json_file(file, json);
}

CampaignState read_campaign_state(const fs::path& file, const ordered_json& settings) {
  CampaignState state;
  state.settings = settings;
  std::error_code error;
  if (!fs::exists(file, error)) {
    return state;
  }
  if (!fs::is_regular_file(file, error)) {
    fail(file.string(), ": is no file; remove it, or give another --out");
  }
  const ordered_json json =
      lab::read_json_file(file, "state of a campaign; remove it, or give another --out", {"campaign", "motions"});
  if (json["campaign"] != settings) {
    fail(file.string(), ": belongs to another campaign, with ", differences(json["campaign"], settings),
         "; give another --out");
  }
  try {
    for (const ordered_json& entry : json["motions"]) {
      MotionOutcome outcome{entry.at("name"), entry.at("v_max_m_s"), {}};
      const ordered_json& runs = entry.at("runs");
      for (const Method method : methods_of(settings)) {
        outcome.runs[method] = summary_from(runs.at(std::string(key(method))));
      }
      state.motions[entry.at("number")] = std::move(outcome);
    }
  } catch (const nlohmann::json::exception& e) {
    fail(file.string(), ": is no state of a campaign: ", e.what());
  }
  return state;
}

}  // namespace depthgrid::experiments
