// Lines from edges.
//
// 1. List both ends of every edge as (kind, vertex, other end), sorted: the edges of one kind at a vertex are
// a range.
// 2. From every vertex with other than two edges of a kind follow each unused edge until such a vertex comes
// again.
// 3. What is left are closed lines: follow each from its smallest vertex.
#include "io/edge_chains.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

struct End {
  EdgeKind kind;
  VertexId from;
  VertexId to;
  bool used = false;
};

bool before(const End& a, const End& b) {
  return std::tuple(a.kind, a.from, a.to) < std::tuple(b.kind, b.from, b.to);
}

class Chainer {
 public:
  explicit Chainer(std::span<const ConstraintEdge> edges) {
    ends_.reserve(2 * edges.size());
    for (const ConstraintEdge& edge : edges) {
      ends_.push_back({edge.kind, edge.a, edge.b});
      ends_.push_back({edge.kind, edge.b, edge.a});
    }
    std::sort(ends_.begin(), ends_.end(), before);
  }

  std::vector<EdgeChain> run() {
    std::vector<EdgeChain> open;
    std::vector<EdgeChain> closed;
    for (End& end : ends_) {
      if (!end.used && at(end.kind, end.from).size() != 2) open.push_back(follow(end));
    }
    for (End& end : ends_) {
      if (!end.used) closed.push_back(follow(end));
    }
    open.insert(open.end(), closed.begin(), closed.end());
    std::stable_sort(open.begin(), open.end(),
                     [](const EdgeChain& a, const EdgeChain& b) { return a.kind < b.kind; });
    return open;
  }

 private:
  std::span<End> at(EdgeKind kind, VertexId from) {
    const auto less = [](const End& a, const End& b) {
      return std::tie(a.kind, a.from) < std::tie(b.kind, b.from);
    };
    const auto [first, last] = std::equal_range(ends_.begin(), ends_.end(), End{kind, from, {}}, less);
    return {first, last};
  }

  void use(End& end) {
    end.used = true;
    std::lower_bound(ends_.begin(), ends_.end(), End{end.kind, end.to, end.from}, before)->used = true;
  }

  EdgeChain follow(End& start) {
    EdgeChain chain{start.kind, {start.from}};
    for (End* end = &start; end != nullptr;) {
      use(*end);
      chain.vertices.push_back(end->to);
      const std::span<End> next = at(end->kind, end->to);
      end = nullptr;
      if (next.size() != 2) break;
      for (End& candidate : next) {
        if (!candidate.used) end = &candidate;
      }
    }
    return chain;
  }

  std::vector<End> ends_;
};

constexpr std::array<std::pair<EdgeKind, std::string_view>, 6> kWords = {{{EdgeKind::Breakline, "breakline"},
                                                                          {EdgeKind::Ridge, "ridge"},
                                                                          {EdgeKind::Valley, "valley"},
                                                                          {EdgeKind::Boundary, "boundary"},
                                                                          {EdgeKind::Hole, "hole"},
                                                                          {EdgeKind::Lake, "lake"}}};

constexpr std::array<std::string_view, 3> kSourceWords = {"point", "line vertex", "crossing"};

}  // namespace

std::vector<EdgeChain> chain_edges(std::span<const ConstraintEdge> edges) {
  return Chainer(edges).run();
}

std::string kind_words(EdgeKind kind) {
  std::string words;
  for (const auto& [bit, word] : kWords) {
    if (has(kind, bit)) words += (words.empty() ? "" : "+") + std::string(word);
  }
  return words.empty() ? "none" : words;
}

std::optional<EdgeKind> parse_kind_words(std::string_view words) {
  EdgeKind kind = EdgeKind::None;
  while (true) {
    const std::string_view word = words.substr(0, words.find('+'));
    const auto* const known =
        std::find_if(kWords.begin(), kWords.end(), [&](const auto& entry) { return entry.second == word; });
    if (known == kWords.end()) return std::nullopt;
    kind = kind | known->first;
    if (word.size() == words.size()) return kind;
    words.remove_prefix(word.size() + 1);
  }
}

std::string source_word(std::uint8_t source) {
  return source < kSourceWords.size() ? std::string(kSourceWords[source]) : "unknown";
}

std::optional<std::uint8_t> parse_source_word(std::string_view word) {
  const auto* const known = std::find(kSourceWords.begin(), kSourceWords.end(), word);
  if (known == kSourceWords.end()) return std::nullopt;
  return static_cast<std::uint8_t>(known - kSourceWords.begin());
}

}  // namespace thalweg
