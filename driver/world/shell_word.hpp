// A word as a shell reads it back.
#pragma once

#include <string>

namespace bounce {

/// The word itself, or in quotes where a shell would take it for something else.
std::string shell_word(const std::string& word);

}  // namespace bounce
