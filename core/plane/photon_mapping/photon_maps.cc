// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/photon_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flatlight {
namespace {

// Widths are chosen at one place for so many photons of a side, but at no more places than these.
constexpr std::size_t kPhotonsPerWidth = 16;
constexpr std::size_t kMostWidths = 64;
constexpr std::size_t kLadder = 12;  // Widths to choose from.
constexpr std::size_t kMostLadders = 1 << 12;
// Of the difference between two widths: where it would have to be more, there is hardly any.
constexpr double kLargestFactor = 4;

// The offsets along the curve that lie on the stretch.
std::pair<double, double> Reach(const Stretches& stretches, const SidePlace& place) {
  const double length = stretches.length(place.side);
  if (stretches.closed(place.side)) return {-0.5 * length, 0.5 * length};
  const double at = std::clamp(place.at, 0.0, length);
  return {-at, length - at};
}

}  // namespace

PhotonMaps::PhotonMaps(const Stretches& stretches, Photons photons, const std::array<double, kReplicates>& paths,
                       const DensityOptions& options, Executor& executor, int max_threads)
    : stretches_(stretches), options_(options), paths_(paths) {
  std::vector<std::vector<Nearby>> runs(kReplicates);
  std::vector<std::optional<SortedPhotons>> sorted(kReplicates);
  executor.ParallelFor(kReplicates, max_threads, [&](std::size_t r) {
    sorted[r].emplace(std::move(photons[r]));
    for (std::size_t i = 0; i < sorted[r]->size(); ++i) {
      const Photon& photon = (*sorted[r])[i];
      runs[r].push_back({photon.side, photon.at, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(i)});
    }
  });
  for (std::optional<SortedPhotons>& replicate : sorted) replicates_.push_back(*std::move(replicate));
  while (runs.size() > 1) {
    std::vector<std::vector<Nearby>> merged(runs.size() / 2);
    executor.ParallelFor(merged.size(), max_threads, [&](std::size_t i) {
      std::merge(runs[2 * i].begin(), runs[2 * i].end(), runs[2 * i + 1].begin(), runs[2 * i + 1].end(),
                 std::back_inserter(merged[i]),
                 [](const Nearby& p, const Nearby& q) { return p.side < q.side || (p.side == q.side && p.at < q.at); });
    });
    runs = std::move(merged);
  }
  nearby_ = std::move(runs.front());
  for (std::size_t i = 0; i < nearby_.size(); ++i) ranges_.Append(nearby_[i].side, i);
  ranges_.End(nearby_.size());
  if (options_.chooses && !options_.bandwidth && !options_.neighbours) ChooseWidths(executor, max_threads);
}

void PhotonMaps::ChooseWidths(Executor& executor, int max_threads) {
  struct Task {
    SidePlace place;
    double photon;
  };
  double paths = 0;
  for (const double of : paths_) paths += of;
  const std::vector<SideId>& sides = ranges_.sides();
  for (std::size_t begin = 0; begin < sides.size();) {
    // Ladders take much memory: of so many sides at a time.
    std::vector<Task> tasks;
    std::vector<std::size_t> ends;
    const std::size_t before = widths_.size();
    for (; begin < sides.size() && tasks.size() < kMostLadders; ++begin) {
      first_width_.push_back(before + tasks.size());
      const auto [first, last] = ranges_.Of(sides[begin]);
      double flux = 0;
      for (std::size_t i = first; i < last; ++i) {
        const Spectrum& of = replicates_[nearby_[i].replicate][nearby_[i].index].flux;
        flux += of[0] + of[1] + of[2];
      }
      const double photon = flux / static_cast<double>(last - first) / paths;
      const std::size_t count = std::clamp((last - first) / kPhotonsPerWidth, std::size_t{1}, kMostWidths);
      for (std::size_t i = 0; i < count; ++i) {
        const double fraction = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        tasks.push_back({{sides[begin], fraction * stretches_.length(sides[begin])}, photon});
      }
      ends.push_back(tasks.size());
    }
    std::vector<WidthLadder> ladders(tasks.size());
    executor.ParallelFor(tasks.size(), max_threads,
                         [&](std::size_t i) { ladders[i] = LadderAt(tasks[i].place, tasks[i].photon); });
    widths_.resize(before + tasks.size());
    executor.ParallelFor(ends.size(), max_threads, [&](std::size_t side) {
      const std::size_t first = side == 0 ? 0 : ends[side - 1];
      WidthChooser chooser;
      for (std::size_t i = first; i < ends[side]; ++i) chooser.Add(ladders[i]);
      for (std::size_t i = first; i < ends[side]; ++i) {
        double width = options_.narrowing * ladders[i].widest;
        for (std::size_t j = chooser.Choose(ladders[i]).chosen; j > 0; --j) width /= WidthLadder::kRatio;
        widths_[before + i] = width;
      }
    });
  }
  first_width_.push_back(widths_.size());
}

WidthLadder PhotonMaps::LadderAt(const SidePlace& place, double photon) const {
  constexpr std::uint32_t kAnyBounces = std::numeric_limits<std::uint32_t>::max();
  WidthLadder ladder;
  ladder.widest = Widest(place);
  ladder.photon = photon;
  double width = ladder.widest;
  for (std::size_t j = 0; j < kLadder; ++j, width /= WidthLadder::kRatio) {
    auto& densities = ladder.densities.emplace_back();
    const DensityWindow window = WindowOf(place, width);
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const Spectrum density = Density(r, window, Width::kFirst, kAnyBounces);
      densities[r] = density[0] + density[1] + density[2];
    }
  }
  return ladder;
}

double PhotonMaps::ChosenWidth(const SidePlace& place) const {
  const std::optional<std::size_t> side = ranges_.Find(place.side);
  if (!side || widths_.empty()) return Widest(place);
  const std::size_t first = first_width_[*side], count = first_width_[*side + 1] - first;
  // Between neighbouring places in proportion.
  const double at = std::clamp(place.at / stretches_.length(place.side) * static_cast<double>(count) - 0.5, 0.0,
                               static_cast<double>(count - 1));
  const auto low = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(low);
  return (1 - share) * widths_[first + low] + share * widths_[first + std::min(low + 1, count - 1)];
}

EndedKernel PhotonMaps::KernelAt(const SidePlace& place, double width) const {
  const auto [low, high] = Reach(stretches_, place);
  return EndedKernel(options_.kernel, low / width, high / width);
}

double PhotonMaps::Widest(const SidePlace& place) const {
  const auto [low, high] = Reach(stretches_, place);
  return std::max(-low, high);
}

DensityWindow PhotonMaps::WindowOf(const SidePlace& place, double width) const {
  DensityWindow window;
  window.place = place;
  window.width = width;
  return window;
}

DensityWindow PhotonMaps::WindowAt(const SidePlace& place) const {
  DensityWindow window;
  window.place = place;
  const double whole = Widest(place);
  window.width = whole;
  if (options_.bandwidth) {
    window.width = std::min(*options_.bandwidth, whole);
  } else if (options_.neighbours) {
    const auto [first, last] = ranges_.Of(place.side);
    const auto wanted = static_cast<std::size_t>(*options_.neighbours);
    if (wanted < last - first) SetNearest(first, last, wanted, window);
  } else {
    window.width = std::min(ChosenWidth(place), whole);
  }
  // Twice as wide; half as wide where, at the ends of a stretch, that would smooth as the first width does.
  const double square = window.width * window.width;
  const double first = square * KernelAt(place, window.width).second_moment;
  const auto further = [&](double width) { return width * width * KernelAt(place, width).second_moment - first; };
  window.other_width = std::min(2 * window.width, whole);
  double more = further(window.other_width);
  if (std::abs(more) < 0.5 * square * SecondMoment(options_.kernel)) {
    window.other_width = 0.5 * window.width;
    more = further(window.other_width);
  }
  window.bias_factor = std::abs(more) * kLargestFactor > std::abs(first) ? first / more : 0;
  return window;
}

// Sets the width to the distance of the last of the nearest `count` of more photons [first, last).
void PhotonMaps::SetNearest(std::size_t first, std::size_t last, std::size_t count, DensityWindow& window) const {
  const auto n = static_cast<std::ptrdiff_t>(last - first), k = static_cast<std::ptrdiff_t>(count);
  const bool closed = stretches_.closed(window.place.side);
  const double length = stretches_.length(window.place.side);
  // On a closed stretch the row goes on before its first and after its last photon.
  const auto photon = [&](std::ptrdiff_t i) -> std::size_t {
    return first + static_cast<std::size_t>(i < 0 ? i + n : i >= n ? i - n : i);
  };
  const auto offset = [&](std::ptrdiff_t i) {
    const double at = window.place.at + (i < 0 ? length : i >= n ? -length : 0);
    return nearby_[photon(i)].at - at;
  };
  std::ptrdiff_t low = closed ? -n : 0, high = closed ? 2 * n - k : n - k;
  while (low < high) {
    const std::ptrdiff_t middle = low + (high - low) / 2;
    // Whether the row of k that begins one later is nearer.
    if (-offset(middle) > offset(middle + k)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  const double left = -offset(low), right = offset(low + k - 1);
  const double width = std::max(left, right);
  if (!(width > 0)) return;  // All in one place.
  const Nearby& farthest = nearby_[photon(left > right ? low : low + k - 1)];
  window.width = width;
  window.left_out_replicate = farthest.replicate;
  window.left_out = farthest.index;
}

Spectrum PhotonMaps::Density(std::size_t replicate, const DensityWindow& window, Width which,
                             std::uint32_t bounces) const {
  const SidePlace& place = window.place;
  const double width = which == Width::kFirst ? window.width : window.other_width;
  const double period = stretches_.closed(place.side) ? stretches_.length(place.side) : 0;
  const EndedKernel kernel = KernelAt(place, width);
  Spectrum density = replicates_[replicate].Density(place, width, period, kernel, bounces);
  if (window.left_out_replicate == replicate && width > window.width) {
    const Photon& photon = replicates_[replicate][window.left_out];
    if (photon.depth <= bounces) {
      double offset = photon.at - place.at;
      if (std::abs(offset) > 1.5 * window.width) offset += offset < 0 ? period : -period;
      density = density + (-kernel(offset / width) / width) * photon.flux;
    }
  }
  return (1 / paths_[replicate]) * density;
}

Spectrum PhotonMaps::Bias(std::size_t replicate, const DensityWindow& window, std::uint32_t bounces) const {
  const Spectrum first = Density(replicate, window, Width::kFirst, bounces);
  return window.bias_factor * (Density(replicate, window, Width::kOther, bounces) + -1.0 * first);
}

Spectrum MapIrradiance::At(const SurfacePoint& on_element, Side side, std::uint32_t bounces) const {
  const DensityWindow window = maps_.WindowAt(maps_.stretches().Locate(on_element.element, on_element.position, side));
  return quantity_ == Quantity::kBias ? maps_.Bias(replicate_, window, bounces)
                                      : maps_.Density(replicate_, window, PhotonMaps::Width::kFirst, bounces);
}

Spectrum PooledIrradiance::At(const SurfacePoint& on_element, Side side, std::uint32_t bounces) const {
  const DensityWindow window = maps_.WindowAt(maps_.stretches().Locate(on_element.element, on_element.position, side));
  std::array<Spectrum, kReplicates> density;
  Spectrum mean;
  for (std::size_t r = 0; r < kReplicates; ++r) {
    density[r] = maps_.Density(r, window, PhotonMaps::Width::kFirst, bounces);
    mean = mean + (1.0 / kReplicates) * density[r];
  }
  if (quantity_ == Quantity::kIrradiance) return mean;
  Spectrum squares, bias;
  for (std::size_t r = 0; r < kReplicates; ++r) {
    const Spectrum off = density[r] - mean;
    squares = squares + off * off;
    bias = bias + (1.0 / kReplicates) * maps_.Bias(r, window, bounces);
  }
  Spectrum doubt;
  for (int c = 0; c < kMaxChannels; ++c)
    doubt[c] = std::sqrt(squares[c] / (kReplicates * (kReplicates - 1))) + std::abs(bias[c]);
  return doubt;
}

}  // namespace flatlight
