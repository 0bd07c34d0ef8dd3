// What libsdformat makes of the worlds beside this file, as golden.json holds it. On Debian 12, in this folder:
//   apt-get install libsdformat-dev && g++ -std=c++17 golden.cpp $(pkg-config --cflags --libs sdformat12) -o
//   /tmp/golden /tmp/golden "$PWD" *.sdf *.world > golden.json

#include <cstdio>
#include <filesystem>
#include <sdf/sdf.hh>

namespace fs = std::filesystem;
using ignition::math::Pose3d;

namespace {

const char* separator = "";

void shape(const std::string& name, const char* kind, std::initializer_list<double> values, const Pose3d& X,
           const std::string& uri = "") {
  std::printf("%s\n    {\"name\": \"%s\", \"kind\": \"%s\", \"values\": [", separator, name.c_str(), kind);
  const char* comma = "";
  for (const double value : values) std::printf("%s%.17g", comma, value), comma = ", ";
  std::printf("], \"position\": [%.17g, %.17g, %.17g], \"quaternion\": [%.17g, %.17g, %.17g, %.17g], \"uri\": \"%s\"}",
              X.Pos().X(), X.Pos().Y(), X.Pos().Z(), X.Rot().X(), X.Rot().Y(), X.Rot().Z(), X.Rot().W(), uri.c_str());
  separator = ",";
}

Pose3d resolved(const sdf::SemanticPose& pose) {
  Pose3d X;
  for (const sdf::Error& error : pose.Resolve(X)) throw std::runtime_error(error.Message());
  return X;
}

void shapes(const sdf::Geometry& g, const Pose3d& X, const std::string& name, const fs::path& folder) {
  if (const auto* box = g.BoxShape()) shape(name, "box", {box->Size().X(), box->Size().Y(), box->Size().Z()}, X);
  if (const auto* c = g.CylinderShape()) shape(name, "cylinder", {c->Radius(), c->Length()}, X);
  if (const auto* s = g.SphereShape()) shape(name, "sphere", {s->Radius()}, X);
  if (const auto* p = g.PlaneShape()) shape(name, "plane", {p->Normal().X(), p->Normal().Y(), p->Normal().Z()}, X);
  if (const auto* c = g.CapsuleShape()) {
    shape(name, "cylinder", {c->Radius(), c->Length()}, X);
    for (const double end : {-0.5, 0.5})
      shape(name, "sphere", {c->Radius()}, X * Pose3d(0, 0, end * c->Length(), 0, 0, 0));
  }
  if (const auto* m = g.MeshShape()) {
    const bool elsewhere = m->Uri().find("://") != std::string::npos;
    const fs::path beside = fs::path(m->FilePath()).parent_path() / m->Uri();
    shape(name, "mesh", {m->Scale().X(), m->Scale().Y(), m->Scale().Z()}, X,
          elsewhere ? m->Uri() : fs::relative(beside, folder).string());
  }
}

void add(const sdf::Model& model, const Pose3d& X_WorldParent, const std::string& prefix, const fs::path& folder) {
  const std::string name = prefix + model.Name();
  const Pose3d X = X_WorldParent * resolved(model.SemanticPose());
  const bool alone = model.LinkCount() == 1 && model.ModelCount() == 0;
  for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
    const sdf::Link& link = *model.LinkByIndex(l);
    const Pose3d X_Link = X * resolved(link.SemanticPose());
    for (std::uint64_t c = 0; c < link.CollisionCount(); ++c)
      shapes(*link.CollisionByIndex(c)->Geom(), X_Link * resolved(link.CollisionByIndex(c)->SemanticPose()),
             alone ? name : name + "::" + link.Name(), folder);
  }
  for (std::uint64_t m = 0; m < model.ModelCount(); ++m) add(*model.ModelByIndex(m), X, name + "::", folder);
}

}  // namespace

int main(int count, char** words) {
  const fs::path folder = words[1];
  std::printf("{");
  for (int k = 2; k < count; ++k) {
    sdf::ParserConfig config;
    config.SetFindCallback([&](std::string uri) {
      if (uri.rfind("model://", 0) == 0) uri = uri.substr(8);
      return (folder / uri).string();
    });
    sdf::Root root;
    for (const sdf::Error& error : root.Load((folder / words[k]).string(), config))
      throw std::runtime_error(error.Message());
    std::printf("%s\n  \"%s\": [", k > 2 ? "," : "", words[k]);
    separator = "";
    if (root.Model() != nullptr) add(*root.Model(), {}, "", folder);
    for (std::uint64_t m = 0; root.WorldCount() > 0 && m < root.WorldByIndex(0)->ModelCount(); ++m)
      add(*root.WorldByIndex(0)->ModelByIndex(m), {}, "", folder);
    std::printf("]");
  }
  std::printf("\n}\n");
}
