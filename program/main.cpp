// The depthgrid command. Exit codes: 0 done, 1 an error while working, 2 a broken command line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "lab/experiments/experiment_command.hpp"
#include "program/demo/demo_command.hpp"
#include "program/distances/distances_command.hpp"
#include "program/info/info_command.hpp"
#include "program/map/map_command.hpp"
#include "program/usage_error.hpp"
#include "program/version.hpp"

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

/// One line on standard error, whatever the message holds.
int report(std::string message, int exit_code) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') {
      c = ' ';
    }
  }
  message = "depthgrid: " + message + "\n";
  (void)std::fputs(message.c_str(), stderr);
  return exit_code;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Computes a lower bound of the distance from control points to space that no depth camera has seen free.",
      "depthgrid");
  app.set_version_flag("--version", std::string("depthgrid ") + depthgrid::program::kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Examples:\n"
      "  depthgrid demo\n"
      "  depthgrid info ../shared/data/kinect3_ball --frames 0:80:8\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point hand=0.1,2.6,1.2 --in floor --frames 0:80:8\n"
      "'depthgrid COMMAND --help' explains a command. Exit codes: 0 done, 1 error, 2 broken command line.");
  depthgrid::program::add_demo_command(app);
  depthgrid::program::add_distances_command(app);
  depthgrid::program::add_info_command(app);
  depthgrid::program::add_map_command(app);
  depthgrid::program::add_experiment_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help and --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
      return report("there is no command '" + std::string(argv[1]) + "' (depthgrid --help lists them)", kUsage);
    }
    return report(std::string(error.what()) + " (depthgrid --help explains)", kUsage);
  } catch (const depthgrid::program::UsageError& error) {
    return report(error.what(), kUsage);
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report("standard output cannot be written", kFailed);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return report("out of memory", kFailed);
  } catch (const std::exception& error) {
    return report(error.what(), kFailed);
  } catch (...) {
    return report("unknown error", kFailed);
  }
}
