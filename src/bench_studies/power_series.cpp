#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/bench_studies/power_series.hpp>
#include <incise/core/batch_monitor.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <set>

namespace incise {
namespace {

/// Body of one specimen: made by the first cut that needs it, released after the last.
class SharedBody {
 public:
  void expect_one_more() { ++expected_; }

  std::shared_ptr<const BenchBody> take(const Specimen& specimen, const BenchResolution& resolution, Monitor& monitor) {
    const std::lock_guard one_makes_it(mutex_);
    if (!body_) {
      Workers alone(1);
      body_ = std::make_shared<const BenchBody>(make_body(specimen, resolution, alone, monitor));
    }
    std::shared_ptr<const BenchBody> body = body_;
    if (--expected_ == 0) body_.reset();
    return body;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const BenchBody> body_;
  std::size_t expected_ = 0;
};

/// One cut that is not in the cache.
struct MissingCut {
  std::size_t subject, place;
};

class PowerSeriesRunner {
 public:
  PowerSeriesRunner(const std::vector<PowerSubject>& subjects, const PowerRequest& request, Cache& kept,
                    Workers& workers, Monitor& monitor)
      : subjects_(subjects), request_(request), kept_(kept), workers_(workers), monitor_(monitor) {}

  PowerSeries run() {
    PowerSeries series;
    for (const PowerSubject& subject : subjects_) {
      for (const double power_w : request_.powers_w)
        series.cuts.push_back(asked(subject, power_w, request_.speed_mm_s));
    }
    make_all(series.cuts, "power series");
    series.choice = choose_power(series.cuts, request_.limits);
    if (series.choice.chosen_w) {
      for (const PowerSubject& subject : subjects_) {
        for (const double speed : request_.speeds_mm_s)
          series.speed_cuts.push_back(asked(subject, *series.choice.chosen_w, speed));
      }
      make_all(series.speed_cuts, "speeds");
    }
    series.made = made_;
    series.speed_mm_s = request_.speed_mm_s;
    series.limits = request_.limits;
    return series;
  }

 private:
  [[nodiscard]] CacheKey key_of(const PowerSubject& subject, const PowerCut& cut) const {
    return power_cut_key(subject.specimen, request_.resolution, cut.power_w, cut.speed_mm_s);
  }

  static PowerCut asked(const PowerSubject& subject, double power_w, double speed_mm_s) {
    return {.specimen = subject.name, .power_w = power_w, .speed_mm_s = speed_mm_s};
  }

  /// @param cuts  equally many for each subject, subject by subject.
  void make_all(std::vector<PowerCut>& cuts, const char* what) {
    const std::size_t each = cuts.size() / subjects_.size();
    std::vector<MissingCut> missing;
    std::vector<SharedBody> bodies(subjects_.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const std::size_t s = i / each;
      const CacheKey key = key_of(subjects_[s], cuts[i]);
      if (auto kept = kept_.find<PowerCut>(slot_of(key), key, monitor_)) {
        cuts[i] = std::move(*kept);
        cuts[i].specimen = subjects_[s].name;  // a specimen's name is not part of its key
        continue;
      }
      missing.push_back({s, i});
      bodies[s].expect_one_more();
    }
    if (cuts.empty()) return;
    monitor_.message(Severity::Notice, fmt::format("{}: {} virtual cuts, {} of them finished already", what,
                                                   cuts.size(), cuts.size() - missing.size()));
    make_missing(missing, bodies, what, cuts);
  }

  void make_missing(const std::vector<MissingCut>& missing, std::vector<SharedBody>& bodies, const char* what,
                    std::vector<PowerCut>& cuts) {
    BatchProgress progress(missing.size(), what, monitor_);
    std::mutex saving;
    std::size_t done = 0;
    workers_.for_each(missing.size(), 1, [&](std::size_t i) {
      JobMonitor own(progress, i);
      PowerCut& cut = cuts[missing[i].place];
      try {
        make(subjects_[missing[i].subject], bodies[missing[i].subject], own, cut);
      } catch (const Cancelled&) {  // reported once all have stopped
        return;
      }
      progress.note(i, 1.0);
      const std::lock_guard one_at_a_time(saving);
      const CacheKey key = key_of(subjects_[missing[i].subject], cut);
      kept_.keep(slot_of(key), key, cut);
      ++done;
    });
    made_ += done;
    if (done < missing.size()) {
      throw Cancelled(
          fmt::format("the power series was interrupted with {} of {} cuts to go", missing.size() - done, cuts.size()));
    }
  }

  void make(const PowerSubject& subject, SharedBody& shared, Monitor& monitor, PowerCut& cut) const {
    throw_if_cancelled(monitor, "cutting");
    StopOnly silent(monitor);  // only the cut reports progress
    const auto body = shared.take(subject.specimen, request_.resolution, silent);
    if (body->outcome == Outcome::NotConverged) {
      cut.problem = "the specimen could not be stretched";
      return;
    }
    const PlanSettings plan{.speed_mm_s = cut.speed_mm_s, .power_w = cut.power_w};
    Workers alone(1);
    try {
      note(*body, cut_as_planned(*body, plan, alone, monitor), cut);
    } catch (const CaseError& no_path) {
      cut.problem = no_path.what();
    }
  }

  /// Records the measures of a cut. A cut that did not converge has none.
  static void note(const BenchBody& body, const BenchCut& seen, PowerCut& cut) {
    cut.outcome = seen.outcome;
    if (seen.outcome == Outcome::NotConverged) return;
    cut.bulge_mm = seen.bulge_mm;
    cut.thermal_width_mm = seen.thermal_width_mm;
    if (!seen.inner_edge) return;
    const std::vector<double> errors = true_errors_mm(body, seen, kInnerEdgeTargetMm);
    double sum = 0.0;
    for (const double e : errors) sum += std::abs(e);
    cut.mean_abs_error_mm = sum / static_cast<double>(errors.size());
  }

  const std::vector<PowerSubject>& subjects_;
  const PowerRequest& request_;
  Cache& kept_;
  Workers& workers_;
  Monitor& monitor_;
  std::size_t made_ = 0;
};

void require_each_once(std::vector<Problem>& violations, const char* name, const std::vector<double>& values) {
  std::set<double> seen;
  for (const double value : values) {
    if (!seen.insert(value).second) violations.push_back({name, fmt::format("{} twice", value), "every value once"});
  }
}

}  // namespace

CacheKey power_cut_key(const Specimen& specimen, const BenchResolution& resolution, double power_w, double speed_mm_s) {
  return CacheKey("power_cut").add(specimen).add(resolution).add(power_w).add(speed_mm_s);
}

std::vector<Problem> validate(const PowerRequest& request) {
  std::vector<Problem> violations = problems_of(request);
  if (request.powers_w.empty()) violations.push_back({"power_w", "none", "at least one power"});
  require_each_once(violations, "power_w", request.powers_w);
  require_each_once(violations, "speeds_mm_s", request.speeds_mm_s);
  const BenchResolution& r = request.resolution;
  Expect{violations}(r.coarse_mm >= r.fine_mm, "resolution.coarse_mm", r.coarse_mm,
                     fmt::format("at least fine_mm = {}", r.fine_mm));
  return violations;
}

PowerSeries run_power_series(const std::vector<PowerSubject>& subjects, const PowerRequest& request, Cache& kept,
                             Workers& workers, Monitor& monitor) {
  require_none(validate(request));
  INCISE_REQUIRE(!subjects.empty(), "expected at least one specimen, found none");
  std::set<std::string> names;
  for (const PowerSubject& subject : subjects) {
    INCISE_REQUIRE(names.insert(subject.name).second,
                   fmt::format("expected every specimen once, found {} twice", subject.name));
  }
  return PowerSeriesRunner(subjects, request, kept, workers, monitor).run();
}

}  // namespace incise
