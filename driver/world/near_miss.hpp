// "Did you mean ...?"
#pragma once

#include <span>
#include <string>

namespace bounce {

/// "; did you mean X?" for the candidate most like `word`, or "" if none is close. Dotted
/// candidates are also compared by their last part, so `alpha` finds `wall.alpha`.
std::string did_you_mean(const std::string& word, std::span<const std::string> candidates);

}  // namespace bounce
