// depthgrid run
#pragma once

namespace CLI {
class App;
}

namespace depthgrid::program {

void add_run_command(CLI::App& app);

}  // namespace depthgrid::program
