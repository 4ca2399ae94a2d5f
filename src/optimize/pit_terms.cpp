// Pits as tables.
//
// 1. A plateau alone is a pit if none of its links is there: a table over their variables, 1 if no literal is
//    true. A long one is a chain with auxiliary variables y that claim that a literal before was true; a
//    false claim costs 1, and saves at most 1, so the least over all claims is right.
// 2. Pits of several plateaus are missed so. Plateaus are put into groups; a group counts the sets of its
//    plateaus that links inside connect and that no link leaves. Whether a link leaves a plateau for another
//    group is claimed as in 1. A component that spans groups leaves each of them, and is counted in none, so
//    the sum is at most the number of pits; it is that number if no pit spans groups.
// 3. The caller solves, and hands the labels in: groups that a pit spans are united, until none is. Labels
//    that are best with terms that count too little, and for them exactly, are best.
#include "optimize/pit_terms.hpp"

#include "base/union_find.hpp"
#include "optimize/normal_angle.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kLiterals = 6;      // of a link of a chain
constexpr std::size_t kMostInTable = 16;  // variables of a group's table

bool is_true(const Literal& literal, std::span<const Label> label) {
  return label[literal.variable] == literal.label;
}

}  // namespace

PitTerms::PitTerms(std::vector<PitLink> links, std::vector<std::int64_t> weight,
                   std::span<const std::int64_t> tie)
    : links_(std::move(links)),
      weight_(std::move(weight)),
      links_at_(weight_.size()),
      group_(weight_.size(), kNone) {
  std::stable_sort(links_.begin(), links_.end(), [&](const PitLink& x, const PitLink& y) {
    const auto key = [&](const Literal& when) {
      return std::tuple(tie[when.variable], when.variable, when.label);
    };
    return key(x.when) < key(y.when);
  });
  const auto join = [&](std::uint32_t node, std::uint32_t link) {
    links_at_[node].push_back(link);
    if (node == 0 || group_[node] != kNone) return;
    group_[node] = static_cast<std::uint32_t>(nodes_of_.size());
    nodes_of_.push_back({node});
  };
  for (std::uint32_t i = 0; i < links_.size(); ++i) {
    join(links_[i].a, i);
    join(links_[i].b, i);
  }
}

std::int64_t PitTerms::constant() const {
  const auto alone = [&](std::size_t node) { return links_at_[node].empty(); };
  std::int64_t sum = 0;
  for (std::size_t node = 1; node < links_at_.size(); ++node) sum += alone(node) ? weight_[node] : 0;
  return sum;
}

/// Writes the terms of one level.
template <std::size_t Criteria>
class PitTerms::Writer {
 public:
  Writer(const PitTerms& terms, Labelling<Criteria>& labelling, std::size_t level)
      : terms_(terms), labelling_(labelling), level_(level) {}

  void write_group(std::span<const std::uint32_t> nodes) {
    const std::uint32_t group = terms_.group_[nodes.front()];
    weight_ = terms_.weight_[nodes.front()];
    std::vector<Literal> leaving(nodes.size());
    std::vector<const PitLink*> inside;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<Literal> out;
      for (const std::uint32_t link : terms_.links_at_[nodes[i]]) {
        const PitLink& found = terms_.links_[link];
        const std::uint32_t other = found.a == nodes[i] ? found.b : found.a;
        if (terms_.group_[other] != group) {
          out.push_back(found.when);
        } else if (found.a == nodes[i]) {
          inside.push_back(&found);
        }
      }
      if (nodes.size() == 1) {
        write_none_of(std::move(out));
        return;
      }
      if (!out.empty()) leaving[i] = {claim_any_of(std::move(out), 0), Label::One};
    }
    write_count(nodes, leaving, inside);
  }

 private:
  std::uint32_t new_variable() {
    labelling_.unary.push_back({});
    labelling_.first.push_back(labelling_.first.back());
    if (!labelling_.link.empty()) labelling_.link.emplace_back();
    return static_cast<std::uint32_t>(labelling_.unary.size() - 1);
  }

  /// A table over the variables of the literals: the pits by which of the literals are true.
  template <class Pits>
  void write(const std::vector<Literal>& literals, const Pits& pits) {
    Table<Criteria> table;
    for (const Literal& literal : literals) {
      const auto end = table.scope.end();
      if (std::find(table.scope.begin(), end, literal.variable) == end) {
        table.scope.push_back(literal.variable);
      }
    }
    std::vector<bool> holds(literals.size());
    for (std::size_t e = 0; e < std::size_t{1} << table.scope.size(); ++e) {
      for (std::size_t i = 0; i < literals.size(); ++i) {
        const auto place =
            std::find(table.scope.begin(), table.scope.end(), literals[i].variable) - table.scope.begin();
        holds[i] = ((e >> place & 1U) != 0) == (literals[i].label == Label::One);
      }
      table.entry.emplace_back()[level_] = pits(holds) * weight_;
    }
    labelling_.tables.append(table);
  }

  /// A variable with label 1 only if one of the literals is true, or at the cost of a pit.
  std::uint32_t claim_any_of(std::vector<Literal> literals, std::size_t most_left) {
    std::uint32_t claim = kNone;
    do {
      const std::size_t count = std::min(literals.size(), kLiterals);
      std::vector<Literal> some(literals.end() - static_cast<std::ptrdiff_t>(count), literals.end());
      literals.resize(literals.size() - count);
      claim = new_variable();
      some.push_back({claim, Label::Zero});
      write(some, [](const std::vector<bool>& holds) {
        return std::find(holds.begin(), holds.end(), true) == holds.end() ? 1 : 0;
      });
      literals.push_back({claim, Label::One});
    } while (literals.size() > std::max<std::size_t>(most_left, 1));
    rest_ = std::move(literals);
    return claim;
  }

  void write_none_of(std::vector<Literal> literals) {
    if (literals.size() > kLiterals) {
      claim_any_of(std::move(literals), kLiterals);
      literals = std::move(rest_);
    }
    write(literals, [](const std::vector<bool>& holds) {
      return std::find(holds.begin(), holds.end(), true) == holds.end() ? 1 : 0;
    });
  }

  void write_count(std::span<const std::uint32_t> nodes, std::span<const Literal> leaving,
                   const std::vector<const PitLink*>& inside) {
    std::vector<Literal> literals;
    literals.reserve(inside.size() + leaving.size());
    for (const PitLink* link : inside) literals.push_back(link->when);
    for (const Literal& literal : leaving) {
      if (literal.variable != kNone) literals.push_back(literal);
    }
    const auto number = [&](std::uint32_t node) {
      return static_cast<std::uint32_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
    };
    write(literals, [&](const std::vector<bool>& holds) {
      UnionFind sets(nodes.size() + 1);  // the last one: left
      std::int64_t pits = static_cast<std::int64_t>(nodes.size());
      const auto unite = [&](std::size_t a, std::size_t b) {
        pits -= sets.unite(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)) ? 1 : 0;
      };
      std::size_t i = 0;
      for (const PitLink* link : inside) {
        if (holds[i++]) unite(number(link->a), number(link->b));
      }
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (leaving[n].variable != kNone && holds[i++]) unite(n, nodes.size());
      }
      return pits;
    });
  }

  const PitTerms& terms_;
  Labelling<Criteria>& labelling_;
  std::size_t level_;
  std::int64_t weight_ = 0;  ///< of a pit of the present group
  std::vector<Literal> rest_;
};

template <std::size_t Criteria>
void PitTerms::add_to(Labelling<Criteria>& labelling, std::size_t level) const {
  Writer<Criteria> writer(*this, labelling, level);
  for (const std::vector<std::uint32_t>& nodes : nodes_of_) {
    if (!nodes.empty()) writer.write_group(nodes);
  }
  labelling.tables.index(labelling.size());
}

std::vector<std::uint32_t> PitTerms::components(std::span<const Label> label) const {
  UnionFind sets(links_at_.size());
  for (const PitLink& link : links_) {
    if (is_true(link.when, label)) sets.unite(link.a, link.b);
  }
  std::vector<std::uint32_t> of(links_at_.size());
  for (std::uint32_t node = 0; node < of.size(); ++node) of[node] = sets.find(node);
  return of;
}

PitTerms::Outcome PitTerms::refine(std::span<const Label> label) {
  const std::vector<std::uint32_t> of = components(label);
  std::vector<std::vector<std::uint32_t>> pits(links_at_.size());
  for (std::uint32_t node = 1; node < of.size(); ++node) {
    if (of[node] != of[0]) pits[of[node]].push_back(node);
  }
  Outcome outcome = Outcome::Exact;
  for (const std::vector<std::uint32_t>& nodes : pits) {
    const bool whole = std::all_of(nodes.begin(), nodes.end(), [&](std::uint32_t node) {
      return nodes.size() == 1 || group_[node] == group_[nodes.front()];
    });
    if (whole) continue;
    if (merge(nodes)) {
      outcome = Outcome::Refined;
    } else if (outcome == Outcome::Exact) {
      outcome = Outcome::TooLarge;
    }
  }
  return outcome;
}

/// Unites the groups of nodes; false if their table would be too large.
bool PitTerms::merge(std::span<const std::uint32_t> nodes) {
  std::vector<std::uint32_t> groups;
  for (const std::uint32_t node : nodes) groups.push_back(group_[node]);
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  const auto among = [&](std::uint32_t node) {
    return std::binary_search(groups.begin(), groups.end(), group_[node]);
  };
  std::vector<std::uint32_t> united;
  for (const std::uint32_t group : groups) {
    united.insert(united.end(), nodes_of_[group].begin(), nodes_of_[group].end());
  }
  std::size_t variables = united.size();
  for (const std::uint32_t node : united) {
    for (const std::uint32_t link : links_at_[node]) {
      variables += links_[link].a == node && among(links_[link].b) ? 1 : 0;
    }
  }
  if (variables > kMostInTable) return false;
  for (const std::uint32_t group : groups) nodes_of_[group].clear();
  for (const std::uint32_t node : united) group_[node] = groups.front();
  nodes_of_[groups.front()] = std::move(united);
  return true;
}

template void PitTerms::add_to(Labelling<1>&, std::size_t) const;
template void PitTerms::add_to(Labelling<2>&, std::size_t) const;
template void PitTerms::add_to(Labelling<4>&, std::size_t) const;

}  // namespace thalweg
