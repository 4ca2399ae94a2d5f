// Draws every scene of a folder: draw_scenes FOLDER writes FOLDER/pictures/NAME.svg.
#include <support/oracle/scene_file.hpp>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

int main(int argc, char** argv) {
  try {
    const std::string folder = argc == 2 ? argv[1] : "";
    std::filesystem::create_directories(folder + "/pictures");
    for (const std::string& name : thalweg::oracle::scene_names(folder)) {
      std::ofstream(folder + "/pictures/" + name + ".svg")
          << thalweg::oracle::picture_of(thalweg::oracle::read_scene(folder, name));
    }
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "usage: draw_scenes FOLDER\n" << e.what() << '\n';
    return 1;
  }
}
