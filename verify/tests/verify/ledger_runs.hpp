// Runs watched by the ledgers, for their tests.
#pragma once

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/oracle/equivalence.hpp"
#include "verify/oracle/oracle_stepper.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/watch/booking_stepper.hpp"
#include "verify/watch/ledger.hpp"

namespace bounce {

inline Plan plan_of(const Scene& scene, const Problem& problem, const std::string& kernel) {
  PlanRequest request;
  request.kernel = kernel;
  request.threads = 1;
  return make_plan(problem, request, kernels_with_oracle(scene));
}

inline const LedgerLine& line(const LedgerReport& report, const std::string& name) {
  for (const LedgerLine& l : report.lines) {
    if (l.name == name) return l;
  }
  throw std::logic_error("no ledger line " + name);
}

inline std::string print(const LedgerReport& report) {
  std::ostringstream text;
  for (const LedgerLine& l : report.lines) {
    text << l.name << ": " << l.residual << ", walk " << l.likely << ", allowed " << l.allowed
         << ", fault at " << l.fault_step << "\n";
  }
  text << report.missed << " missed, " << report.otherwise << " otherwise";
  return text.str();
}

inline void look(Ledger& ledger, const Problem& problem, const Stepper& stepper,
                 const WallBooks* books = nullptr) {
  const State state = stepper.state();
  ledger.add(stepper.step(), state, measure(problem, state), books);
}

/// A run watched by the cheap ledger.
inline LedgerReport watched(const Problem& problem, Stepper& stepper, std::int64_t steps,
                            std::int64_t every = 1000) {
  Ledger ledger(problem);
  look(ledger, problem, stepper);
  while (stepper.step() < steps) {
    stepper.advance(every);
    look(ledger, problem, stepper);
  }
  return ledger.report();
}

/// A run with books.
inline LedgerReport booked(const Problem& problem, BookingStepper& stepper, std::int64_t steps,
                           std::int64_t every = 1000) {
  Ledger ledger(problem, true);
  look(ledger, problem, stepper, &stepper.books());
  while (stepper.step() < steps) {
    stepper.advance(every);
    look(ledger, problem, stepper, &stepper.books());
  }
  return ledger.report();
}

inline Scene at_wall(int example, const std::string& method = "listing",
                     Contact contact = Contact::listing) {
  Scene scene = at_the_wall(paper_scene(example));
  scene.time.method = method;
  for (Wall& wall : scene.walls) wall.contact = contact;
  return scene;
}

}  // namespace bounce
