#include "driver/world/near_miss.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace bounce {
namespace {

// Levenshtein: letters to insert, remove or replace.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string last_part(const std::string& dotted) { return dotted.substr(dotted.rfind('.') + 1); }

}  // namespace

std::string did_you_mean(const std::string& word, std::span<const std::string> candidates) {
  if (word.size() > 60) return "";
  // A third of the letters wrong is still a slip; more is another word.
  std::size_t best = std::max<std::size_t>(2, last_part(word).size() / 3) + 1;
  const std::string* nearest = nullptr;
  for (const std::string& candidate : candidates) {
    const std::size_t distance =
        std::min(edits(word, candidate), edits(last_part(word), last_part(candidate)));
    if (distance < best && distance < last_part(candidate).size()) {
      best = distance;
      nearest = &candidate;
    }
  }
  return nearest != nullptr ? "; did you mean " + *nearest + "?" : "";
}

}  // namespace bounce
