#include "kernels/plan/plan.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "kernels/stepping/threads.hpp"

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
  throw PlanError("kernel", "kernel " + name + ": no such kernel; allowed are " + join(names));
}

// Tries entries for a problem.
class Choice {
 public:
  explicit Choice(std::span<const KernelEntry> entries) : entries_(entries) {}

  [[nodiscard]] Preparation prepare(const KernelEntry& entry, const Problem& problem,
                                    const KernelRequest& request) const {
    if (!entry.has_contacts_of(problem.walls))
      return Refusal{"it does not have the rule of contact of these walls"};
    const auto inside = [this](const Problem& other, const KernelRequest& asked) {
      return pick(other, asked, false);
    };
    Preparation prepared = entry.prepare(problem, request, inside);
    if (auto* plan = std::get_if<Plan>(&prepared)) plan->kernel = entry.name;
    return prepared;
  }

  // The kernel asked for, or the first automatic one. `wrapped`: one that wraps another may be it.
  [[nodiscard]] Preparation pick(const Problem& problem, const KernelRequest& request,
                                 bool wrapped) const {
    if (request.kernel != "auto") return forced(problem, request, wrapped);
    std::vector<std::string> refusals;
    for (const KernelEntry& entry : entries_) {
      if (!entry.automatic) continue;
      if (entry.wraps && !(wrapped && entry.has_contacts_of(problem.walls))) continue;
      Preparation prepared = prepare(entry, problem, request);
      if (auto* plan = std::get_if<Plan>(&prepared)) {
        plan->reasons.insert(plan->reasons.end(), refusals.begin(), refusals.end());
        return prepared;
      }
      refusals.push_back("not " + entry.name + ": " + std::get<Refusal>(prepared).why);
    }
    return Refusal{join(refusals)};
  }

 private:
  [[nodiscard]] Preparation forced(const Problem& problem, KernelRequest request,
                                   bool wrapped) const {
    const KernelEntry& entry = find_entry(request.kernel, entries_);
    if (entry.has_contacts_of(problem.walls)) {
      if (entry.wraps) request.kernel = "auto";  // inside
      return prepare(entry, problem, request);
    }
    for (const KernelEntry& other : entries_) {
      if (wrapped && other.wraps && other.has_contacts_of(problem.walls)) {
        return prepare(other, problem, request);
      }
    }
    return prepare(entry, problem, request);
  }

  std::span<const KernelEntry> entries_;
};

}  // namespace

VectorTarget choose_vector(const std::string& wanted) {
  const std::vector<VectorTarget> available = available_vectors();
  if (available.empty()) {
    throw PlanError("",
                    "this processor has no AVX2 with fused multiply-add, which the kernels need");
  }
  if (wanted == "auto") return available.front();
  std::vector<std::string_view> names{"auto"};
  for (const VectorTarget target : available) {
    if (name_of(target) == wanted) return target;
    names.push_back(name_of(target));
  }
  throw PlanError("vector",
                  "vector " + wanted + ": not available here; allowed are " + join(names));
}

void check_threads(int threads) {
  if (threads < 0 || threads > most_threads) {
    throw PlanError("threads", "threads " + std::to_string(threads) + ": allowed is 1 to " +
                                   std::to_string(most_threads) + ", or 0 to leave it to the plan");
  }
}

Plan make_plan(const Problem& problem, const PlanRequest& request,
               std::span<const KernelEntry> entries) {
  check_threads(request.threads);
  const int cores = request.more_threads_than_cores ? most_threads : usable_cores();
  const KernelRequest asked{request.kernel, choose_vector(request.vector), request.vector != "auto",
                            std::min(request.threads, cores)};
  Preparation prepared = Choice(entries).pick(problem, asked, true);
  if (auto* plan = std::get_if<Plan>(&prepared)) {
    if (request.kernel != "auto") plan->reasons.emplace_back("the kernel was forced");
    if (request.threads > cores) {
      plan->reasons.emplace_back(std::to_string(request.threads) +
                                 " threads were asked for; the cores it may use are " +
                                 std::to_string(cores) + ", and more threads are slower");
    }
    return std::move(*plan);
  }
  const std::string& why = std::get<Refusal>(prepared).why;
  if (request.kernel == "auto") throw PlanError("", "no kernel can run this scene: " + why);
  throw PlanError("kernel", "kernel " + request.kernel + " cannot run this scene: " + why);
}

Plan make_plan(Problem&& problem, const PlanRequest& request,
               std::span<const KernelEntry> entries) {
  const auto kept = std::make_shared<const Problem>(std::move(problem));
  Plan plan = make_plan(*kept, request, entries);
  plan.make_stepper = [kept, make = plan.make_stepper] { return make(); };
  return plan;
}

std::unique_ptr<Stepper> make_stepper(const Problem& problem, const PlanRequest& request,
                                      std::span<const KernelEntry> entries) {
  return make_plan(problem, request, entries).make_stepper();
}

std::string kernel_name(const Plan& plan) {
  return plan.inside.empty() ? plan.kernel : plan.kernel + " (" + plan.inside + ")";
}

}  // namespace bounce
