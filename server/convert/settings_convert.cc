// SPDX-License-Identifier: Apache-2.0
#include "server/convert/settings_convert.h"

#include <optional>

#include "server/convert/unknown_fields.h"

namespace flatlight {
namespace {

v1::Settings::Method ToProto(Method method) {
  switch (method) {
    case Method::kExact:
      return v1::Settings::EXACT;
    case Method::kPathTracing:
      return v1::Settings::PATH_TRACING;
    case Method::kRayTracing:
      return v1::Settings::RAY_TRACING;
    case Method::kReference:
      return v1::Settings::REFERENCE;
    case Method::kIrradianceCaching:
      return v1::Settings::IRRADIANCE_CACHING;
    case Method::kPhotonMapping:
      return v1::Settings::PHOTON_MAPPING;
  }
  return v1::Settings::METHOD_UNSPECIFIED;
}

v1::Settings::Formulation ToProto(Formulation formulation) {
  switch (formulation) {
    case Formulation::kStratified:
      return v1::Settings::STRATIFIED;
    case Formulation::kPolyline:
      return v1::Settings::POLYLINE;
    case Formulation::kArcLength:
      return v1::Settings::ARC_LENGTH;
  }
  return v1::Settings::FORMULATION_UNSPECIFIED;
}

v1::Settings::ErrorControl ToProto(ErrorControl control) {
  switch (control) {
    case ErrorControl::kSplitSphere:
      return v1::Settings::SPLIT_SPHERE;
    case ErrorControl::kBoundedSplitSphere:
      return v1::Settings::BOUNDED_SPLIT_SPHERE;
    case ErrorControl::kRadiometricHessian:
      return v1::Settings::RADIOMETRIC_HESSIAN;
    case ErrorControl::kGeometricHessian:
      return v1::Settings::GEOMETRIC_HESSIAN;
    case ErrorControl::kOcclusionHessian:
      return v1::Settings::OCCLUSION_HESSIAN;
    case ErrorControl::kVisibilityEvents:
      return v1::Settings::VISIBILITY_EVENTS;
  }
  return v1::Settings::ERROR_CONTROL_UNSPECIFIED;
}

v1::Settings::Kernel ToProto(Kernel kernel) {
  switch (kernel) {
    case Kernel::kBox:
      return v1::Settings::BOX;
    case Kernel::kTriangle:
      return v1::Settings::TRIANGLE;
    case Kernel::kEpanechnikov:
      return v1::Settings::EPANECHNIKOV;
    case Kernel::kBiweight:
      return v1::Settings::BIWEIGHT;
  }
  return v1::Settings::KERNEL_UNSPECIFIED;
}

v1::Settings::Gather ToProto(Gather gather) {
  switch (gather) {
    case Gather::kReference:
      return v1::Settings::FROM_REFERENCE;
    case Gather::kRayTracing:
      return v1::Settings::FROM_RAY_TRACING;
    case Gather::kPhotonMap:
      return v1::Settings::FROM_PHOTON_MAP;
  }
  return v1::Settings::GATHER_UNSPECIFIED;
}

// Absent if it names none that is known here.
std::optional<ErrorControl> FromProto(v1::Settings::ErrorControl proto) {
  for (const ErrorControl control :
       {ErrorControl::kSplitSphere, ErrorControl::kBoundedSplitSphere, ErrorControl::kRadiometricHessian,
        ErrorControl::kGeometricHessian, ErrorControl::kOcclusionHessian, ErrorControl::kVisibilityEvents}) {
    if (ToProto(control) == proto) return control;
  }
  return std::nullopt;
}

v1::Settings::Derivatives ToProto(Derivatives derivatives) {
  switch (derivatives) {
    case Derivatives::kNone:
      return v1::Settings::NONE;
    case Derivatives::kGradient:
      return v1::Settings::GRADIENT;
    case Derivatives::kHessian:
      return v1::Settings::HESSIAN;
  }
  return v1::Settings::DERIVATIVES_UNSPECIFIED;
}

v1::Plan::Skip::Decision ToProto(SkipDecision decision) {
  switch (decision) {
    case SkipDecision::kTaken:
      return v1::Plan::Skip::TAKEN;
    case SkipDecision::kNotApplicable:
      return v1::Plan::Skip::NOT_APPLICABLE;
    case SkipDecision::kDisabled:
      return v1::Plan::Skip::DISABLED;
  }
  return v1::Plan::Skip::DECISION_UNSPECIFIED;
}

}  // namespace

Settings SettingsFromProto(const v1::Settings& proto, Diagnostics& diagnostics) {
  ReportUnknownFields(proto, "settings", diagnostics);
  Settings settings;
  if (proto.method() == v1::Settings::EXACT) settings.method = Method::kExact;
  if (proto.method() == v1::Settings::PATH_TRACING) settings.method = Method::kPathTracing;
  if (proto.method() == v1::Settings::RAY_TRACING) settings.method = Method::kRayTracing;
  if (proto.formulation() == v1::Settings::STRATIFIED) settings.formulation = Formulation::kStratified;
  if (proto.formulation() == v1::Settings::POLYLINE) settings.formulation = Formulation::kPolyline;
  if (proto.formulation() == v1::Settings::ARC_LENGTH) settings.formulation = Formulation::kArcLength;
  if (proto.method() == v1::Settings::REFERENCE) settings.method = Method::kReference;
  if (proto.method() == v1::Settings::IRRADIANCE_CACHING) settings.method = Method::kIrradianceCaching;
  if (proto.method() == v1::Settings::PHOTON_MAPPING) settings.method = Method::kPhotonMapping;
  if (proto.gather() == v1::Settings::FROM_REFERENCE) settings.gather = Gather::kReference;
  if (proto.gather() == v1::Settings::FROM_RAY_TRACING) settings.gather = Gather::kRayTracing;
  if (proto.gather() == v1::Settings::FROM_PHOTON_MAP) settings.gather = Gather::kPhotonMap;
  settings.error_control = FromProto(proto.error_control());
  if (proto.has_extrapolation()) settings.extrapolation = proto.extrapolation();
  if (proto.has_tolerance()) settings.tolerance = proto.tolerance();
  if (proto.has_neighbour_clamping()) settings.neighbour_clamping = proto.neighbour_clamping();
  if (proto.has_overture()) settings.overture = proto.overture();
  if (proto.has_max_records()) settings.max_records = proto.max_records();
  if (proto.has_photons()) settings.photons = proto.photons();
  if (proto.has_final_gather()) settings.final_gather = proto.final_gather();
  if (proto.has_bandwidth()) settings.bandwidth = proto.bandwidth();
  if (proto.has_neighbours()) settings.neighbours = proto.neighbours();
  for (const Kernel kernel : {Kernel::kBox, Kernel::kTriangle, Kernel::kEpanechnikov, Kernel::kBiweight})
    if (proto.kernel() == ToProto(kernel)) settings.kernel = kernel;
  if (proto.has_samples()) settings.samples = proto.samples();
  if (proto.has_max_bounces()) settings.max_bounces = proto.max_bounces();
  if (proto.has_seed()) settings.seed = proto.seed();
  if (proto.derivatives() == v1::Settings::NONE) settings.derivatives = Derivatives::kNone;
  if (proto.derivatives() == v1::Settings::GRADIENT) settings.derivatives = Derivatives::kGradient;
  if (proto.derivatives() == v1::Settings::HESSIAN) settings.derivatives = Derivatives::kHessian;
  if (proto.has_target_error()) settings.target_error = proto.target_error();
  if (proto.has_time_limit()) settings.time_limit = proto.time_limit();
  if (proto.has_threads()) settings.threads = proto.threads();
  settings.no_skip.assign(proto.no_skip().begin(), proto.no_skip().end());
  return settings;
}

v1::Settings SettingsToProto(const Settings& settings) {
  v1::Settings proto;
  if (settings.method) proto.set_method(ToProto(*settings.method));
  if (settings.samples) proto.set_samples(*settings.samples);
  if (settings.max_bounces) proto.set_max_bounces(*settings.max_bounces);
  if (settings.seed) proto.set_seed(*settings.seed);
  if (settings.derivatives) proto.set_derivatives(ToProto(*settings.derivatives));
  if (settings.formulation) proto.set_formulation(ToProto(*settings.formulation));
  if (settings.target_error) proto.set_target_error(*settings.target_error);
  if (settings.time_limit) proto.set_time_limit(*settings.time_limit);
  if (settings.threads) proto.set_threads(*settings.threads);
  if (settings.error_control) proto.set_error_control(ToProto(*settings.error_control));
  if (settings.gather) proto.set_gather(ToProto(*settings.gather));
  if (settings.extrapolation) proto.set_extrapolation(*settings.extrapolation);
  if (settings.tolerance) proto.set_tolerance(*settings.tolerance);
  if (settings.neighbour_clamping) proto.set_neighbour_clamping(*settings.neighbour_clamping);
  if (settings.overture) proto.set_overture(*settings.overture);
  if (settings.max_records) proto.set_max_records(*settings.max_records);
  if (settings.photons) proto.set_photons(*settings.photons);
  if (settings.final_gather) proto.set_final_gather(*settings.final_gather);
  if (settings.bandwidth) proto.set_bandwidth(*settings.bandwidth);
  if (settings.neighbours) proto.set_neighbours(*settings.neighbours);
  if (settings.kernel) proto.set_kernel(ToProto(*settings.kernel));
  for (const std::string& name : settings.no_skip) proto.add_no_skip(name);
  return proto;
}

v1::Plan PlanToProto(const Plan& plan) {
  v1::Plan proto;
  *proto.mutable_settings() = SettingsToProto(plan.settings);
  for (const SkipEntry& entry : plan.skips) {
    v1::Plan::Skip& skip = *proto.add_skips();
    skip.set_name(entry.name);
    skip.set_decision(ToProto(entry.decision));
    skip.set_reason(entry.reason);
  }
  for (const PlanPass& entry : plan.passes) {
    v1::Plan::Pass& pass = *proto.add_passes();
    pass.set_name(entry.name);
    pass.set_points(entry.points);
    pass.set_samples(entry.samples);
    pass.set_expected_rays(entry.expected_rays);
  }
  proto.set_summary(plan.summary);
  return proto;
}

Plan PlanFromProto(const v1::Plan& proto) {
  Plan plan;
  Diagnostics diagnostics;  // There are none in what PlanToProto wrote.
  plan.settings = SettingsFromProto(proto.settings(), diagnostics);
  for (const v1::Plan::Skip& skip : proto.skips()) {
    SkipDecision decision = SkipDecision::kNotApplicable;
    if (skip.decision() == v1::Plan::Skip::TAKEN) decision = SkipDecision::kTaken;
    if (skip.decision() == v1::Plan::Skip::DISABLED) decision = SkipDecision::kDisabled;
    plan.skips.push_back({skip.name(), decision, skip.reason()});
  }
  for (const v1::Plan::Pass& pass : proto.passes()) {
    plan.passes.push_back({pass.name(), pass.points(), pass.samples(), pass.expected_rays()});
  }
  plan.summary = proto.summary();
  return plan;
}

}  // namespace flatlight
