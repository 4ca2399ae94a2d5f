// Every target on what it starts with, on its folder of the corpus, and on a fixed number of mutants of both.
// THALWEG_MUTANTS sets the number, THALWEG_SEED the seed. build/.../fuzz/TARGET.last holds the input that ran
// last, for a crash.
#include "fuzz/mutant.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/target.hpp"

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace thalweg::fuzz {
namespace {

std::vector<std::string> inputs_of(const Target& target) {
  std::vector<std::string> inputs = target.seeds();
  const std::filesystem::path folder =
      std::filesystem::path(THALWEG_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& file : files) inputs.push_back(read_file(file.string()));
  return inputs;
}

class FuzzTargets : public testing::TestWithParam<std::string_view> {
 protected:
  const Target& target() { return find_target(GetParam()); }

  void run(const std::string& input) {
    write_file(last_, input);
    try {
      target().run(input);
    } catch (const std::exception& error) {
      const std::string kept = last_ + "-finding";
      write_file(kept, input);
      ADD_FAILURE() << error.what() << "\nThe input is " << kept;
    }
  }

  std::string last_ = std::string(THALWEG_FUZZ_DIR) + "/" + std::string(GetParam()) + ".last";
};

TEST_P(FuzzTargets, Corpus) {
  for (const std::string& input : inputs_of(target())) run(input);
}

TEST_P(FuzzTargets, Mutants) {
  const char* const wanted = std::getenv("THALWEG_MUTANTS");
  const std::size_t count = wanted == nullptr ? 400 : std::strtoull(wanted, nullptr, 10);
  const std::vector<std::string> inputs = inputs_of(target());
  test::Random random;
  SCOPED_TRACE(random.trace());
  Mutants mutants(inputs, random.engine()());
  for (std::size_t i = 0; i < count && !HasFailure(); ++i) run(mutants.next());
}

std::vector<std::string_view> names() {
  std::vector<std::string_view> all;
  for (const Target& target : targets()) all.push_back(target.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargets, testing::ValuesIn(names()),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace thalweg::fuzz
