// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/flux.h"

#include "tests/bench/stress/random.h"
#include "tests/bench/stress/solve.h"

namespace flatlight::stress {

std::optional<Flux> MeasureFlux(SceneDescription scene, const FluxSide& side, int strata, std::uint32_t samples,
                                std::uint64_t seed) {
  Random random(seed);
  scene.probes.clear();
  for (int i = 0; i < 2 * strata; ++i) {
    const double place = (i / 2 + random.Uniform(1e-9, 1 - 1e-9)) / strata;
    ProbeDescription probe;
    probe.name = std::to_string(i);
    probe.curve = side.curve;
    probe.count = 1;
    probe.side = side.side;
    probe.from = place - 1e-12;
    probe.to = place + 1e-12;
    scene.probes.push_back(probe);
  }
  const Built built(scene);
  if (!built.scene) return std::nullopt;
  const std::optional<Field> field =
      RenderField(built, Sampled(samples, static_cast<std::uint32_t>(Mixed(seed, 1)), std::nullopt));
  if (!field) return std::nullopt;
  const double length = built.scene->curve(built.scene->probes()[0].curve).length * built.scene->frame().scale *
                        side.absorptance / strata;
  Flux flux;
  for (std::size_t i = 0; i < field->probes.size(); i += 2) {
    const double a = field->probes[i].irradiance[0], b = field->probes[i + 1].irradiance[0];
    flux.watts += length * (a + b) / 2;
    flux.variance += length * length * (a - b) * (a - b) / 4;
  }
  return flux;
}

}  // namespace flatlight::stress
