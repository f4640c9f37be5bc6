#include "kernels/rings/ring_forms.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "kernels/model/method.hpp"
#include "kernels/stepping/law_form.hpp"
#include "kernels/stepping/threads.hpp"

namespace bounce {
namespace {

std::string refuses_law(LawForm form, int rings) {
  if (form == LawForm::three_five || (has_ring_law(form) && rings == 3)) return {};
  return has_ring_law(form) ? "exponents other than (3, 5) are compiled for three rings only"
                            : "its exponents (p, q) are not one of (3, 5), (7, 13), (2, 4)";
}

// Of the law, a bond (vector_law-inl.hpp); roots are not counted.
int law_multiplications(LawForm form) {
  switch (form) {
    case LawForm::three_five:
      return 3;  // u^2, H u - G, their product
    case LawForm::seven_thirteen:
      return 6;  // u^2 and its square, u^3 in two, H u^3 - G, their product
    default:
      return 3;  // u u^(1/2), H u - G, their product
  }
}

}  // namespace

bool has_ring_law(LawForm form) {
  return form == LawForm::three_five || form == LawForm::seven_thirteen ||
         form == LawForm::two_four;
}

std::string deal_columns(std::int64_t columns, std::int64_t fewest, bool even,
                         const KernelRequest& request, Plan& plan) {
  std::vector<VectorTarget> targets{request.vector};
  if (!request.vector_is_forced && request.vector == VectorTarget::avx512) {
    targets.push_back(VectorTarget::avx2);
  }
  for (const VectorTarget target : targets) {
    const int lanes = lanes_of(target);
    if (columns < fewest * lanes || (even && columns % lanes != 0)) continue;
    plan.vector = target;
    plan.lanes = lanes;
    return {};
  }
  const std::string lanes = std::to_string(lanes_of(targets.back()));
  return std::to_string(columns) + " columns are not dealt " + (even ? "evenly " : "") + "to " +
         lanes + " lanes, " + std::to_string(fewest) + " at least each";
}

RingForm find_ring_form(const Problem& problem) {
  const auto shape = find_rings(problem.bonds);
  if (!shape) {
    return {{},
            "the neighbour list is not 1 to " + std::to_string(most_rings) +
                " concentric rings with constant offsets"};
  }
  return {*shape, refuses_law(law_form(problem.law), shape->rings)};
}

void describe_rings(const std::string& why, Plan& plan) {
  plan.reasons.push_back(why + ": each bond once, no index, " + std::to_string(plan.lanes) +
                         " sectors side by side");
  plan.left_out.emplace_back("neighbour index and gathers");
  plan.left_out.emplace_back("the second computation of each bond");
}

int team_size(std::int64_t columns) {
  constexpr std::int64_t columns_that_pay = 7;  // 0.1 to 0.2 us (ring in results/throughput.md)
  constexpr std::int64_t small = 256;           // columns: 100 kB with 4 lanes and three rings
  const std::int64_t threads = default_threads();
  const std::int64_t most = columns < small ? 2 : threads;
  return static_cast<int>(
      std::clamp<std::int64_t>(std::min(threads, columns / columns_that_pay), 1, most));
}

void deal_threads(std::int64_t columns, std::int64_t fewest, const KernelRequest& request,
                  int usual, Plan& plan) {
  plan.threads = request.threads == 0 ? usual : request.threads;
  const std::int64_t most = std::max<std::int64_t>(1, columns / fewest);
  if (plan.threads <= most) return;
  plan.threads = static_cast<int>(most);
  plan.reasons.emplace_back(std::to_string(columns) + " columns of vectors are enough for " +
                            std::to_string(plan.threads) + " threads: a thread needs " +
                            std::to_string(fewest));
}

RingTraversal ring_traversal(std::size_t columns, std::size_t threads, std::size_t bytes_a_column) {
  constexpr std::size_t cached_bytes =
      std::size_t{256} * 1024;                // a second-level cache has 512 kB or more
  constexpr std::size_t columns_alone = 128;  // with so many a thread takes several stages alone
  if (threads > 1)
    return columns / threads < columns_alone ? RingTraversal::team : RingTraversal::tiles;
  return columns * bytes_a_column <= cached_bytes ? RingTraversal::loop : RingTraversal::tiles;
}

double ring_multiplications(const Problem& problem, int rings, std::int64_t columns) {
  // To share a division among 1, 2, 3, 4 bonds (reciprocals_of).
  constexpr std::array<int, 5> to_share{0, 0, 3, 6, 9};
  const int bonds = 3 * rings - 2;
  const int a_bond = 2 + law_multiplications(law_form(problem.law)) + 4;
  const int a_column = bonds * a_bond + bonds / 4 * to_share[4] +
                       to_share[static_cast<std::size_t>(bonds % 4)] + 2 * rings;
  return static_cast<double>(columns) * a_column * problem.method->evaluations;
}

double annulus_multiplications(const Problem& problem, int rings, std::int64_t columns) {
  const int a_bond = 2 + law_multiplications(law_form(problem.law)) + 4;
  constexpr int to_share_among_three = 6;
  const int a_ring = 3 * a_bond + to_share_among_three + 2;
  return static_cast<double>(columns) * ((rings - 1) * a_ring + a_bond + 2) *
         problem.method->evaluations;
}

}  // namespace bounce
