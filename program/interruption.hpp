// What happens when somebody stops the program: Ctrl-C, kill, a closed terminal.
#pragma once

#include <string>

namespace depthgrid::program {

/// From now on SIGINT, SIGTERM and SIGHUP remove the temporary files of outputs under way, write one line on standard
/// error after `program_name` and end the process with exit code 128 + the signal's number. A signal that was ignored
/// stays ignored (nohup).
void end_tidily_on_signals(const std::string& program_name);

/// From now on the first of these signals only makes stop_is_asked() true, so that work ends with its summary; the
/// second ends the process as above. Only after end_tidily_on_signals().
void ask_before_the_end();
[[nodiscard]] bool stop_is_asked() noexcept;

}  // namespace depthgrid::program
