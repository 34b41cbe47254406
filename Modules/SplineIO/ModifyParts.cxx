// SPDX-License-Identifier: BSD-3-Clause
#include "ModifyParts.h"

#include "CADParts.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <cstdlib>

namespace knotwork
{
namespace
{
/// Both directions go through the same functions Transfer, which say what is handed over.
class PartWriter
{
public:
  static constexpr bool Reads = false;
  explicit PartWriter(std::vector<std::string>& parts) : Parts(parts) {}

  void operator()(std::string& value) { this->Parts.push_back(value); }
  void operator()(double& value) { this->Parts.push_back(ExactText(value)); }
  void operator()(int& value) { this->Parts.push_back(std::to_string(value)); }

private:
  std::vector<std::string>& Parts;
};

class PartReader
{
public:
  static constexpr bool Reads = true;
  explicit PartReader(const std::vector<std::string>& parts) : Parts(parts) {}

  void operator()(std::string& value)
  {
    this->Failed = this->Failed || this->Next >= this->Parts.size();
    value = this->Failed ? std::string() : this->Parts[this->Next++];
  }
  void operator()(double& value) { value = ExactNumber(this->Word()); }
  void operator()(int& value) { value = std::atoi(this->Word().c_str()); }

  /// What is left can have this many.
  int Bounded(int count)
  {
    this->Failed = this->Failed || count < 0 ||
      static_cast<std::size_t>(count) > this->Parts.size() - this->Next;
    return this->Failed ? 0 : count;
  }
  bool Done() const { return !this->Failed && this->Next == this->Parts.size(); }

private:
  std::string Word()
  {
    std::string word;
    (*this)(word);
    return word;
  }

  const std::vector<std::string>& Parts;
  std::size_t Next = 0;
  bool Failed = false;
};

template <typename Archive>
int Count(Archive& archive, std::size_t now)
{
  auto count = static_cast<int>(now);
  archive(count);
  if constexpr (Archive::Reads)
  {
    count = archive.Bounded(count);
  }
  return count;
}

template <typename Archive, typename Value>
void Each(Archive& archive, std::vector<Value>& values)
{
  values.resize(static_cast<std::size_t>(Count(archive, values.size())));
  for (Value& value : values)
  {
    if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, double> ||
      std::is_same_v<Value, std::string>)
    {
      archive(value);
    }
    else
    {
      Transfer(archive, value);
    }
  }
}

template <typename Archive>
void Transfer(Archive& archive, std::vector<int>& values)
{
  Each(archive, values);
}

template <typename Archive, typename Enumeration>
void Choice(Archive& archive, Enumeration& value)
{
  auto number = static_cast<int>(value);
  archive(number);
  value = static_cast<Enumeration>(number);
}

template <typename Archive>
void Transfer(Archive& archive, Eigen::Vector3d& vector)
{
  for (double& value : vector)
  {
    archive(value);
  }
}

/// A curve of tensor kind; others, and damaged ones, become empty.
template <typename Archive>
void Transfer(Archive& archive, Spline<1>& curve)
{
  int degree = 0;
  std::vector<double> knots;
  std::vector<double> points(
    curve.ControlPoints.data(), curve.ControlPoints.data() + curve.ControlPoints.size());
  std::vector<double> weights(curve.Weights.data(), curve.Weights.data() + curve.Weights.size());
  int columns = static_cast<int>(curve.ControlPoints.cols());
  if (curve.Space && !curve.Space->Knots.empty())
  {
    degree = curve.Space->Knots[0].Degree();
    knots = curve.Space->Knots[0].Knots();
  }
  archive(degree);
  archive(columns);
  Each(archive, knots);
  Each(archive, points);
  Each(archive, weights);
  if constexpr (Archive::Reads)
  {
    const auto vector = KnotVector::Create(degree, knots);
    if (vector && columns > 0)
    {
      curve.Space = MakeTensorSpace<1>({ vector.Value }).Value;
      curve.ControlPoints = Eigen::Map<const PointMatrix>(
        points.data(), static_cast<Eigen::Index>(points.size()) / columns, columns);
      curve.Weights = Eigen::Map<const Eigen::VectorXd>(
        weights.data(), static_cast<Eigen::Index>(weights.size()));
    }
  }
}

template <typename Archive>
void Transfer(Archive& archive, CADOperation& operation)
{
  Choice(archive, operation.Kind);
  Each(archive, operation.Faces);
  archive(operation.Tool);
  Transfer(archive, operation.Point);
  Transfer(archive, operation.Direction);
  archive(operation.Radius);
  archive(operation.IsoDirection);
  archive(operation.Share);
  Each(archive, operation.Curves);
  archive(operation.Tolerance);
}

template <typename Archive>
void Transfer(Archive& archive, CADCounts& counts)
{
  for (int* count :
    { &counts.Solids, &counts.Faces, &counts.Edges, &counts.Vertices, &counts.FaceIds })
  {
    archive(*count);
  }
  archive(counts.Volume);
}

template <typename Archive>
void Transfer(Archive& archive, CADHealing& healing)
{
  for (int* count : { &healing.TurnedFaces, &healing.TurnedSolids, &healing.SewnEdges,
         &healing.NewSolids, &healing.RemovedEdges, &healing.RemovedFaces, &healing.ClosedGaps })
  {
    archive(*count);
  }
  std::vector<std::string> texts;
  std::vector<int> numbers;
  for (const auto& [text, number] : healing.Messages)
  {
    texts.push_back(text);
    numbers.push_back(number);
  }
  Each(archive, texts);
  Each(archive, numbers);
  for (std::size_t i = 0; i < texts.size() && i < numbers.size(); ++i)
  {
    healing.Messages[texts[i]] = numbers[i];
  }
  Each(archive, healing.Unmended);
}

template <typename Archive>
void Transfer(Archive& archive, CADStep& step)
{
  Choice(archive, step.Kind);
  Transfer(archive, step.Before);
  Transfer(archive, step.After);
  archive(step.VolumeChange);
  archive(step.Overlap);
  Each(archive, step.NewFaces);
  Transfer(archive, step.Healing);
  archive(step.Composite.Name);
  Each(archive, step.Composite.Faces);
}

template <typename Archive>
void Transfer(Archive& archive, ModifyTask& task)
{
  Choice(archive, task.Params.Unit);
  archive(task.Params.VolumeTolerance);
  Each(archive, task.Operations);
}

template <typename Archive>
void Transfer(Archive& archive, ModifiedCAD& made)
{
  archive(made.Text);
  Each(archive, made.Steps);
}

template <typename Whole>
void Append(Whole whole, std::vector<std::string>& parts)
{
  PartWriter writer(parts);
  Transfer(writer, whole);
}

template <typename Whole>
Result<Whole> Take(const std::vector<std::string>& parts)
{
  Whole whole;
  PartReader reader(parts);
  Transfer(reader, whole);
  if (!reader.Done())
  {
    return { ErrorCode::InvalidFormat, "it cannot be handed over between processes" };
  }
  return whole;
}
}

void AppendTask(const ModifyTask& task, std::vector<std::string>& parts)
{
  Append(task, parts);
}

Result<ModifyTask> TakeTask(const std::vector<std::string>& parts)
{
  return Take<ModifyTask>(parts);
}

void AppendModified(const ModifiedCAD& made, std::vector<std::string>& parts)
{
  Append(made, parts);
}

Result<ModifiedCAD> TakeModified(const std::vector<std::string>& parts)
{
  return Take<ModifiedCAD>(parts);
}
}
