#include "kernels/plan/plan.hpp"

#include <hwy/targets.h>

#include <algorithm>

#include "kernels/model/wall_rule.hpp"
#include "kernels/contact/located.hpp"
#include "kernels/stepping/scene_forms.hpp"

namespace bounce {
namespace {

constexpr int most_threads = 256;

template <class Names>
std::string join(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

const KernelEntry& find_entry(const std::string& name, std::span<const KernelEntry> entries) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const KernelEntry& entry) { return entry.name == name; });
  if (found != entries.end()) return *found;
  std::vector<std::string> names{"auto"};
  for (const KernelEntry& entry : entries) names.push_back(entry.name);
  throw PlanError("--kernel " + name + ": no such kernel; allowed are " + join(names));
}

// Fills a plan for one entry; returns why it cannot run the problem, or nothing.
std::string prepare(const KernelEntry& entry, const Problem& problem, const PlanRequest& request,
                    Plan& plan) {
  plan.kernel = entry.name;
  const LawForm law = law_form(problem.law);
  const WallForm walls = wall_form(problem);
  plan.law = describe(law);
  plan.walls = describe(walls);
  if (any_resolved(problem.walls)) plan.walls += ", contact resolved";
  plan.left_out = left_out(law, walls);
  return entry.prepare(problem, request, plan);
}

// The plan of the kernel that flies (located.hpp).
Plan make_located_plan(const Problem& problem, const PlanRequest& request,
                       std::span<const KernelEntry> entries) {
  const std::string refusal = located_refusal(problem);
  if (!refusal.empty()) throw PlanError("this scene cannot be run: " + refusal);
  Plan plan = make_plan(as_resolved(problem), request, entries);
  plan.walls = describe(wall_form(problem)) + ", contact located";
  plan.left_out.emplace_back("wall test where no wall is near");
  plan.reasons.emplace_back("contact located: near a wall, one thread in plain code");
  return plan;
}

}  // namespace

VectorTarget choose_vector(const std::string& wanted) {
  const std::vector<VectorTarget> available = available_vectors();
  if (available.empty()) {
    throw PlanError("this processor has no AVX2 with fused multiply-add, which the kernels need");
  }
  if (wanted == "auto") return available.front();
  std::vector<std::string_view> names{"auto"};
  for (const VectorTarget target : available) {
    if (name_of(target) == wanted) return target;
    names.push_back(name_of(target));
  }
  throw PlanError("--vector " + wanted + ": not available here; allowed are " + join(names));
}

void check_threads(int threads) {
  if (threads < 0 || threads > most_threads) {
    throw PlanError("--threads " + std::to_string(threads) + ": allowed is 1 to " +
                    std::to_string(most_threads) + ", or 0 to leave it to the plan");
  }
}

std::string_view name_of(VectorTarget target) {
  switch (target) {
    case VectorTarget::avx2:
      return "avx2";
    case VectorTarget::avx512:
      return "avx512";
    case VectorTarget::none:
      break;
  }
  return "none";
}

std::vector<VectorTarget> available_vectors() {
  std::vector<VectorTarget> available;
  const auto targets = static_cast<std::int64_t>(hwy::SupportedTargets());
  // Highway 1.0.3 asks the processor, the compiler's check also the operating system, which may not
  // save the wide registers.
  const bool saves_512 = __builtin_cpu_supports("avx512f") != 0;
  const bool saves_256 = __builtin_cpu_supports("avx2") != 0;
  if ((targets & HWY_AVX3) != 0 && saves_512) available.push_back(VectorTarget::avx512);
  if ((targets & HWY_AVX2) != 0 && saves_256) available.push_back(VectorTarget::avx2);
  return available;
}

Plan make_plan(const Problem& problem, const PlanRequest& request,
               std::span<const KernelEntry> entries) {
  check_threads(request.threads);
  if (is_located(problem.walls)) return make_located_plan(problem, request, entries);
  const bool automatic = request.kernel == "auto";
  Plan fresh;
  fresh.vector = choose_vector(request.vector);
  if (!automatic) {
    Plan plan = fresh;
    const KernelEntry& entry = find_entry(request.kernel, entries);
    const std::string refusal = prepare(entry, problem, request, plan);
    if (!refusal.empty()) {
      throw PlanError("--kernel " + request.kernel + " cannot run this scene: " + refusal);
    }
    plan.reasons.emplace_back("the kernel was forced");
    return plan;
  }
  std::vector<std::string> refusals;
  for (const KernelEntry& entry : entries) {
    if (!entry.automatic) continue;
    Plan plan = fresh;
    const std::string refusal = prepare(entry, problem, request, plan);
    if (refusal.empty()) {
      plan.reasons.insert(plan.reasons.end(), refusals.begin(), refusals.end());
      return plan;
    }
    refusals.push_back("not " + entry.name + ": " + refusal);
  }
  throw PlanError("no kernel can run this scene: " + join(refusals));
}

std::unique_ptr<Stepper> make_stepper(const Problem& problem, const Plan& plan,
                                      std::span<const KernelEntry> entries) {
  if (is_located(problem.walls)) {
    return make_located(problem, plan.kernel == "mirror",
                        [&](const Problem& open) { return make_stepper(open, plan, entries); });
  }
  auto stepper = find_entry(plan.kernel, entries).make(problem, plan);
  if (!stepper) throw PlanError("kernel " + plan.kernel + " has no form for this plan");
  return stepper;
}

}  // namespace bounce
