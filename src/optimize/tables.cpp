// Terms as tables: building, slicing, comparing.
#include "optimize/tables.hpp"

#include <algorithm>
#include <utility>

namespace thalweg {

template <std::size_t Criteria>
bool Tables<Criteria>::reach_level(std::size_t level) const {
  return std::any_of(entry_.begin(), entry_.end(),
                     [&](const Weight<Criteria>& entry) { return entry[level] != 0; });
}

template <std::size_t Criteria>
void Tables<Criteria>::append(const Table<Criteria>& table) {
  variable_.insert(variable_.end(), table.scope.begin(), table.scope.end());
  first_variable_.push_back(static_cast<std::uint32_t>(variable_.size()));
  entry_.insert(entry_.end(), table.entry.begin(), table.entry.end());
  first_entry_.push_back(entry_.size());
}

template <std::size_t Criteria>
void Tables<Criteria>::append(const Tables& tables) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    first_variable_.push_back(static_cast<std::uint32_t>(variable_.size() + tables.first_variable_[i + 1]));
    first_entry_.push_back(entry_.size() + tables.first_entry_[i + 1]);
  }
  variable_.insert(variable_.end(), tables.variable_.begin(), tables.variable_.end());
  entry_.insert(entry_.end(), tables.entry_.begin(), tables.entry_.end());
}

template <std::size_t Criteria>
void Tables<Criteria>::clear_level(std::size_t level) {
  Tables kept;
  for (std::size_t i = 0; i < size(); ++i) {
    Table<Criteria> table{{scope(i).begin(), scope(i).end()}, {entries(i).begin(), entries(i).end()}};
    for (Weight<Criteria>& entry : table.entry) entry[level] = 0;
    table = without_idle(std::move(table));
    if (!table.scope.empty()) kept.append(table);
  }
  *this = std::move(kept);
}

template <std::size_t Criteria>
void Tables<Criteria>::index(std::size_t variable_count) {
  if (empty()) return;
  first_of_.assign(variable_count + 1, 0);
  for (const std::uint32_t v : variable_) ++first_of_[v + 1];
  for (std::size_t v = 0; v < variable_count; ++v) first_of_[v + 1] += first_of_[v];
  of_.resize(variable_.size());
  std::vector<std::uint32_t> fill(first_of_.begin(), first_of_.end() - 1);
  for (std::uint32_t i = 0; i < size(); ++i) {
    for (const std::uint32_t v : scope(i)) of_[fill[v]++] = i;
  }
}

Slice slice_of(std::span<const std::uint32_t> scope, std::span<const Label> label) {
  Slice slice;
  for (std::size_t j = 0; j < scope.size(); ++j) {
    if (label[scope[j]] == Label::One) slice.base |= std::size_t{1} << j;
    if (label[scope[j]] == Label::Open) slice.open |= std::size_t{1} << j;
  }
  return slice;
}

template <std::size_t Criteria>
Table<Criteria> without_idle(Table<Criteria> table) {
  for (std::size_t j = table.scope.size(); j-- > 0;) {
    const std::size_t bit = std::size_t{1} << j;
    std::vector<Weight<Criteria>> half;
    half.reserve(table.entry.size() / 2);
    bool idle = true;
    for (std::size_t e = 0; idle && e < table.entry.size(); ++e) {
      if ((e & bit) != 0) continue;
      idle = table.entry[e] == table.entry[e | bit];
      half.push_back(table.entry[e]);
    }
    if (!idle) continue;
    table.entry = std::move(half);
    table.scope.erase(table.scope.begin() + static_cast<std::ptrdiff_t>(j));
  }
  return table;
}

template <std::size_t Criteria>
Table<Criteria> with_sorted_scope(const Table<Criteria>& table) {
  Table<Criteria> sorted{table.scope, {}};
  std::sort(sorted.scope.begin(), sorted.scope.end());
  std::vector<std::size_t> bit;
  for (const std::uint32_t variable : sorted.scope) {
    const auto place = std::find(table.scope.begin(), table.scope.end(), variable) - table.scope.begin();
    bit.push_back(std::size_t{1} << place);
  }
  for (std::size_t e = 0; e < table.entry.size(); ++e) {
    std::size_t from = 0;
    for (std::size_t j = 0; j < bit.size(); ++j) from |= (e >> j & 1U) != 0 ? bit[j] : 0;
    sorted.entry.push_back(table.entry[from]);
  }
  return sorted;
}

template <std::size_t Criteria>
Table<Criteria> condition(const Tables<Criteria>& tables, std::size_t i, std::span<const Label> label) {
  const std::span<const std::uint32_t> scope = tables.scope(i);
  const std::span<const Weight<Criteria>> entries = tables.entries(i);
  const auto [base, open] = slice_of(scope, label);
  Table<Criteria> table;
  for (std::size_t j = 0; j < scope.size(); ++j) {
    if ((open >> j & 1U) != 0) table.scope.push_back(scope[j]);
  }
  table.entry.reserve(std::size_t{1} << table.scope.size());
  std::size_t bits = 0;
  do {
    table.entry.push_back(entries[base | bits]);
    bits = (bits - open) & open;  // the next subset of `open`
  } while (bits != 0);
  return without_idle(std::move(table));
}

template <std::size_t Criteria>
std::pair<Weight<Criteria>, Weight<Criteria>> spread(const Tables<Criteria>& tables, std::size_t i,
                                                     std::uint32_t variable, std::span<const Label> label) {
  const std::span<const std::uint32_t> scope = tables.scope(i);
  const std::span<const Weight<Criteria>> entries = tables.entries(i);
  const std::size_t bit = std::size_t{1} << (std::find(scope.begin(), scope.end(), variable) - scope.begin());
  auto [base, open] = slice_of(scope, label);
  open &= ~bit;
  base &= ~bit;
  std::pair<Weight<Criteria>, Weight<Criteria>> range;
  std::size_t bits = 0;
  do {
    Weight<Criteria> more = entries[base | bits | bit];
    for (std::size_t level = 0; level < Criteria; ++level) more[level] -= entries[base | bits][level];
    if (bits == 0 || more < range.first) range.first = more;
    if (bits == 0 || range.second < more) range.second = more;
    bits = (bits - open) & open;
  } while (bits != 0);
  return range;
}

template class Tables<1>;
template class Tables<2>;
template class Tables<4>;
template Table<1> without_idle(Table<1>);
template Table<2> without_idle(Table<2>);
template Table<4> without_idle(Table<4>);
template Table<1> with_sorted_scope(const Table<1>&);
template Table<2> with_sorted_scope(const Table<2>&);
template Table<4> with_sorted_scope(const Table<4>&);
template Table<1> condition(const Tables<1>&, std::size_t, std::span<const Label>);
template Table<2> condition(const Tables<2>&, std::size_t, std::span<const Label>);
template Table<4> condition(const Tables<4>&, std::size_t, std::span<const Label>);
template std::pair<Weight<1>, Weight<1>> spread(const Tables<1>&, std::size_t, std::uint32_t,
                                                std::span<const Label>);
template std::pair<Weight<2>, Weight<2>> spread(const Tables<2>&, std::size_t, std::uint32_t,
                                                std::span<const Label>);
template std::pair<Weight<4>, Weight<4>> spread(const Tables<4>&, std::size_t, std::uint32_t,
                                                std::span<const Label>);

}  // namespace thalweg
