// Instead of the commands that ask the oracle of the tests, where the tests are not built.
#include <CLI/CLI.hpp>

#include "depthgrid/core/error.hpp"
#include "lab/commands.hpp"

namespace depthgrid::lab {
namespace {

void add_absent(CLI::App& app, const std::string& name) {
  CLI::App* const command = app.add_subcommand(name, "asks the oracle of the tests, which this build leaves out");
  command->allow_extras();
  command->callback([name] {
    fail(name,
         " needs the oracle of the tests, which this build leaves out; configure with -DDEPTHGRID_BUILD_TESTS=ON");
  });
}

}  // namespace

void add_speed_command(CLI::App& app) { add_absent(app, "speed"); }
void add_campaign_command(CLI::App& app) { add_absent(app, "campaign"); }
void add_worlds_command(CLI::App& app) { add_absent(app, "worlds"); }
void add_letter_errors_command(CLI::App& letter) { add_absent(letter, "errors"); }

}  // namespace depthgrid::lab
