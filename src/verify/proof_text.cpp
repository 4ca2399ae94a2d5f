// Lines of words and numbers.
#include <thalweg/base/error.hpp>
#include <thalweg/verify/proof.hpp>

#include <array>
#include <charconv>
#include <istream>
#include <optional>
#include <utility>

namespace thalweg::verify {

namespace {

constexpr auto kSteps =
    std::to_array<std::pair<std::string_view, StepKind>>({{"cut", StepKind::Cut},
                                                          {"fix", StepKind::Fix},
                                                          {"eliminate", StepKind::Eliminate},
                                                          {"forest", StepKind::Forest},
                                                          {"conflict", StepKind::Conflict}});

class Reader {
 public:
  Reader(std::istream& text, const std::string& name) : text_(text), name_(name) {}

  Proof run() {
    if (!next() || line_ != "thalweg-proof 1") fail("is no proof of this program; give what --proof wrote");
    while (!proof_.complete && next()) take();
    return std::move(proof_);
  }

 private:
  bool next() {
    ++number_;
    return static_cast<bool>(std::getline(text_, line_));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::BadFormat, name_ + " line " + std::to_string(number_) + " " + what);
  }

  void take() {
    const std::size_t space = std::min(line_.find(' '), line_.size());
    const std::string_view word = std::string_view(line_).substr(0, space);
    const std::string_view rest = std::string_view(line_).substr(std::min(space + 1, line_.size()));
    if (word == "digest") {
      proof_.digest = rest;
    } else if (word == "definition") {
      proof_.definition = rest;
    } else if (word == "criteria") {
      proof_.criteria = rest;
    } else if (word == "quadrilaterals") {
      proof_.quadrilateral_count = static_cast<std::size_t>(only_number(rest));
    } else if (word == "q") {
      proof_.quadrilaterals.push_back(numbers(rest, false));
    } else if (word == "stage") {
      const bool alone = rest.ends_with(" alone");
      const std::string_view number = rest.substr(0, rest.size() - (alone ? 6 : 0));
      proof_.stages.push_back({static_cast<std::size_t>(only_number(number)), alone, {}});
    } else if (word == "end") {
      proof_.complete = true;
    } else {
      take_step(word, rest);
    }
  }

  void take_step(std::string_view word, std::string_view rest) {
    for (const auto& [name, kind] : kSteps) {
      if (word != name) continue;
      if (proof_.stages.empty()) fail("stands before the first stage");
      const bool literals = kind == StepKind::Cut || kind == StepKind::Fix;
      proof_.stages.back().steps.push_back({kind, numbers(rest, literals), number_});
      return;
    }
    fail("starts with '" + std::string(word) + "', which says nothing here");
  }

  std::int64_t only_number(std::string_view text) const {
    const std::vector<std::int64_t> all = numbers(text, false);
    if (all.size() != 1 || all.front() < 0) fail("needs one number");
    return all.front();
  }

  [[nodiscard]] std::vector<std::int64_t> numbers(std::string_view text, bool literals) const {
    std::vector<std::int64_t> all;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
      std::int64_t value = 0;
      const auto [rest, error] = std::from_chars(at, end, value);
      const bool signed_right = !literals || (rest != end && (*rest == '+' || *rest == '-') && value >= 0 &&
                                              value < std::int64_t{1} << 40U);
      if (error != std::errc() || !signed_right) fail("holds something other than numbers");
      at = rest;
      if (literals) value = 2 * value + (*at++ == '+' ? 1 : 0);
      if (at != end && *at++ != ' ') fail("holds something other than numbers");
      all.push_back(value);
    }
    return all;
  }

  std::istream& text_;
  const std::string& name_;
  std::string line_;
  std::size_t number_ = 0;
  Proof proof_;
};

}  // namespace

Proof read_proof(std::istream& text, const std::string& name) {
  return Reader(text, name).run();
}

}  // namespace thalweg::verify
