// A libFuzzer program of one target, THALWEG_FUZZ_TARGET. With `--seeds FOLDER` alone it writes what to start
// with.
#include "fuzz/target.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

namespace {

const thalweg::fuzz::Target& target() {
  static const thalweg::fuzz::Target& found = thalweg::fuzz::find_target(THALWEG_FUZZ_TARGET);
  return found;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count != 3 || std::string((*words)[1]) != "--seeds") return 0;
  int number = 0;
  for (const std::string& seed : target().seeds()) {
    std::ofstream file(std::string((*words)[2]) + "/seed-" + std::to_string(number++), std::ios::binary);
    file.write(seed.data(), static_cast<std::streamsize>(seed.size()));
  }
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  target().run({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
