// Reference solutions in a command's journal.
#pragma once

#include "driver/output/journal.hpp"
#include "verify/accuracy/reference_pair.hpp"

namespace bounce {

/// Keeps solutions as cases of the journal, which has to outlive it.
inline ReferenceKeeper kept_in(Journal& journal) {
  return {[&journal](const std::string& name) {
            return journal.find<ReferencePath>("reference " + name);
          },
          [&journal](const std::string& name, const ReferencePath& path) {
            journal.add("reference " + name, path);
          }};
}

}  // namespace bounce
