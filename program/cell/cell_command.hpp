// depthgrid cell show, check, new
#pragma once

namespace CLI {
class App;
}

namespace depthgrid::program {

void add_cell_command(CLI::App& app);

}  // namespace depthgrid::program
