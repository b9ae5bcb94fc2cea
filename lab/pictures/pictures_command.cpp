#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "lab/commands.hpp"
#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {

void add_pictures_command(CLI::App& app) {
  const auto folder = std::make_shared<std::string>("docs/images");
  CLI::App* const command =
      app.add_subcommand("pictures", "draws the pictures that explain a page of docs/ each: some seconds");
  command->add_option("FOLDER", *folder, "where to")->check(CLI::ExistingDirectory)->capture_default_str();
  command->callback([folder] {
    for (const ExplainingPicture& picture : kExplainingPictures) {
      const auto file = std::filesystem::path(*folder) / file_name(picture);
      picture.draw().save_png(file);
      std::cout << file.string() << '\n';
    }
  });
}

}  // namespace depthgrid::lab
