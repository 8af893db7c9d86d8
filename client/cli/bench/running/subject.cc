// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/running/subject.h"

#include <algorithm>
#include <map>

#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/formats/settings_text.h"
#include "client/cli/scenes/scene_list.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kMostTruthBytes = 2'000'000'000;
constexpr std::size_t kHashDigits = 16;  // 64 bits of each: enough to tell scenes apart, and to read.

std::string Message(const absl::Status& status) {
  return std::string(status.message().data(), status.message().size());
}

struct TruthFile {
  std::string path;
  std::string name;
  const v1::RenderResult* result;
  bool used = false;
};

class Preparation {
 public:
  Preparation(Connection& connection, const BenchOptions& options, const v1::Settings& settings)
      : connection_(connection), options_(options), settings_(settings) {}

  absl::StatusOr<Subjects> Run() {
    if (absl::Status read = ReadTruths(); !read.ok()) return read;
    auto arguments = SceneArguments();
    if (!arguments.ok()) return arguments.status();
    for (const SceneArgument& argument : *arguments)
      if (absl::Status added = Add(argument); !added.ok()) return added;
    for (const auto& [note, labels] : labels_) all_.notes.push_back(labels + ": " + note);
    for (const TruthFile& file : files_)
      if (!file.used)
        return UsageError("--truth: " + file.path + " is of none of the scenes (by its worldHash and probeHash)");
    return std::move(all_);
  }

 private:
  absl::Status ReadTruths() {
    for (const std::string& path : options_.truths) {
      const std::string label = Printable(path);
      const auto bytes = ReadFile(path, label, kMostTruthBytes, connection_.interruption());
      if (!bytes.ok()) return bytes.status();
      auto result = ResultFromJson(*bytes, label);
      if (!result.ok()) return result.status();
      all_.truths.push_back(std::make_unique<v1::RenderResult>(*std::move(result)));
      files_.push_back({label, "file " + Sha256Hex(*bytes).substr(0, kHashDigits), all_.truths.back().get()});
    }
    return absl::OkStatus();
  }

  absl::StatusOr<std::vector<SceneArgument>> SceneArguments() {
    std::vector<SceneArgument> arguments;
    if (options_.gallery) {
      const auto list = ListScenes(connection_);
      if (!list.ok()) return list.status();
      for (const v1::SceneInfo& scene : list->scenes())
        if (scene.gallery())
          arguments.push_back({"gallery:" + scene.name().substr(scene.name().find('/') + 1), scene.name(), ""});
    }
    for (const std::string& text : options_.scenes) {
      auto argument = ParseSceneArgument(text);
      if (!argument.ok()) return argument.status();
      arguments.push_back(*std::move(argument));
    }
    return arguments;
  }

  absl::Status Add(const SceneArgument& argument) {
    Subject subject;
    subject.argument = argument;
    auto source = ProvideScene(connection_, argument);
    if (!source.ok()) return source.status();
    subject.source = *std::move(source);
    const auto validation = ValidateScene(connection_, subject.source);
    if (!validation.ok()) return ExplainSceneError(connection_, argument, subject.source, validation.status());
    if (!validation->diagnostics().empty()) return UsageError(DiagnosticLines(argument, *validation));
    subject.hash =
        validation->world_hash().substr(0, kHashDigits) + "." + validation->probe_hash().substr(0, kHashDigits);
    for (const Subject& other : all_.subjects)
      if (other.hash == subject.hash)
        return UsageError(argument.label + " is the same scene as " + other.argument.label + "; give it once");
    if (absl::Status chosen = Choose(*validation, subject); !chosen.ok()) return chosen;
    if (absl::Status added = AddMethods(subject); !added.ok()) return added;
    all_.subjects.push_back(std::move(subject));
    return absl::OkStatus();
  }

  // The user's file for the scene; a result without hashes may be of any, if it is the only one.
  TruthFile* FileFor(const v1::ValidateSceneResponse& scene) {
    for (TruthFile& file : files_) {
      const v1::RenderResult& result = *file.result;
      const bool unknown = result.world_hash().empty() && files_.size() == 1;
      if (unknown || (result.world_hash() == scene.world_hash() && result.probe_hash() == scene.probe_hash()))
        return &file;
    }
    return nullptr;
  }

  absl::Status Choose(const v1::ValidateSceneResponse& scene, Subject& subject) {
    TruthQuestion question;
    question.max_reflectance = scene.traits().max_reflectance();
    if (settings_.has_max_bounces()) question.max_bounces = settings_.max_bounces();
    const auto reference = TakesReference(scene.traits(), subject);
    if (!reference.ok()) return reference.status();
    question.reference = *reference;
    question.samples = options_.truth_samples;
    if (TruthFile* file = FileFor(scene)) {
      file->used = true;
      question.file = file->result;
      question.file_name = file->name;
    }
    subject.truth = ChooseTruth(question, connection_.capabilities());
    if (!subject.truth.render && subject.truth.file == nullptr)
      return UsageError(subject.argument.label + ": " + subject.truth.note);
    if (!subject.truth.note.empty())
      labels_[subject.truth.note] += (labels_[subject.truth.note].empty() ? "" : ", ") + subject.argument.label;
    if (subject.truth.render) {
      for (const std::string& skip : settings_.no_skip()) subject.truth.render->add_no_skip(skip);
      if (settings_.has_threads()) subject.truth.render->set_threads(settings_.threads());
    }
    return absl::OkStatus();
  }

  // What it can do is the server's to say.
  absl::StatusOr<bool> TakesReference(const v1::SceneTraits& traits, const Subject& subject) {
    // Over mirrors and glass each piece is much work: of many a truth is not to be had while one waits.
    constexpr double kMostPieces = 128;
    if (!traits.lambertian() && traits.elements() > kMostPieces) return false;
    const auto& methods = connection_.capabilities().methods();
    if (std::find(methods.begin(), methods.end(), "reference") == methods.end()) return false;
    v1::Settings settings;
    settings.set_method(v1::Settings::REFERENCE);
    if (settings_.has_max_bounces()) settings.set_max_bounces(settings_.max_bounces());
    const auto plan = Explain(subject, settings);
    if (plan.ok()) return true;
    if (plan.status().code() == absl::StatusCode::kInvalidArgument) return false;
    return plan.status();
  }

  absl::Status AddMethods(Subject& subject) {
    std::vector<std::string> names = options_.methods;
    if (names.empty()) {
      names.assign(connection_.capabilities().methods().begin(), connection_.capabilities().methods().end());
      // Against itself it has no error.
      names.erase(std::remove(names.begin(), names.end(), "reference"), names.end());
    }
    const auto& type = *google::protobuf::GetEnumDescriptor<v1::Settings::Method>();
    absl::Status failure;
    std::vector<std::string> notes;
    for (const std::string& name : names) {
      const auto value = OptionValue(type, name);
      if (!value) continue;  // A method that the server has and this program does not know.
      auto method = Explained(subject, name, static_cast<v1::Settings::Method>(*value));
      if (method.ok()) {
        subject.methods.push_back(*std::move(method));
      } else if (!options_.methods.empty() || method.status().code() != absl::StatusCode::kInvalidArgument) {
        return method.status();
      } else {
        failure = method.status();
        notes.push_back(subject.argument.label + " without " + name + ": " + Message(failure));
      }
    }
    // What is wrong for every method is most likely not theirs.
    if (subject.methods.empty())
      return failure.ok() ? UsageError("the server has no method that is known here") : failure;
    all_.notes.insert(all_.notes.end(), notes.begin(), notes.end());
    return absl::OkStatus();
  }

  // What a method makes of the settings is the server's to say: it fills in the defaults of those that it takes.
  absl::StatusOr<BenchMethod> Explained(const Subject& subject, const std::string& name, v1::Settings::Method value) {
    BenchMethod method;
    method.name = name;
    method.settings.set_method(value);
    if (subject.truth.max_bounces) method.settings.set_max_bounces(*subject.truth.max_bounces);
    if (settings_.has_threads()) method.settings.set_threads(settings_.threads());
    *method.settings.mutable_no_skip() = settings_.no_skip();
    auto plan = Explain(subject, method.settings);
    if (!plan.ok()) return plan.status();
    if (settings_.derivatives() != 0 && settings_.derivatives() < plan->settings().derivatives()) {
      method.settings.set_derivatives(settings_.derivatives());
      plan = Explain(subject, method.settings);
      if (!plan.ok()) return plan.status();
    }
    v1::Settings settings = plan->settings();
    method.takes_samples = settings.has_samples();
    method.takes_seed = settings.has_seed();
    method.takes_photons = method.takes_samples && settings.has_photons();
    method.threads = settings.threads();
    settings.clear_method();
    settings.clear_samples();
    if (method.takes_photons) settings.clear_photons();
    settings.clear_seed();
    settings.clear_threads();
    method.text = SettingsText(settings);
    return method;
  }

  absl::StatusOr<v1::Plan> Explain(const Subject& subject, const v1::Settings& settings) {
    v1::ExplainJobRequest request;
    *request.mutable_scene() = subject.source;
    *request.mutable_settings() = settings;
    v1::ExplainJobResponse response;
    const absl::Status status =
        connection_.Call(connection_.render(), &v1::RenderService::Stub::ExplainJob, request, response);
    if (!status.ok()) return ExplainSceneError(connection_, subject.argument, subject.source, status);
    return response.plan();
  }

  Connection& connection_;
  const BenchOptions& options_;
  const v1::Settings& settings_;
  Subjects all_;
  std::vector<TruthFile> files_;
  std::map<std::string, std::string> labels_;  // Scenes by the note that is due to them.
};

}  // namespace

absl::StatusOr<Subjects> PrepareSubjects(Connection& connection, const BenchOptions& options,
                                         const v1::Settings& settings) {
  return Preparation(connection, options, settings).Run();
}

}  // namespace flatlight
