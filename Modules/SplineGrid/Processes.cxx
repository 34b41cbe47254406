// SPDX-License-Identifier: BSD-3-Clause
#include "Processes.h"

#include "vtkMultiProcessController.h"
#include "vtkType.h"

#include <algorithm>
#include <numeric>

namespace knotwork::Processes
{
namespace
{
constexpr int Tag = 1873; ///< of messages between two processes

Traffic Told;

void AddToTraffic(std::size_t bytes)
{
  ++Told.Messages;
  Told.Bytes += bytes;
}

vtkMultiProcessController* Controller()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr;
}

// one message each: what is sent may be larger than what a collective operation counts
void Send(vtkMultiProcessController* controller, const std::string& bytes, int to)
{
  AddToTraffic(bytes.size());
  const auto length = static_cast<vtkIdType>(bytes.size());
  controller->Send(&length, 1, to, Tag);
  if (length > 0)
  {
    controller->Send(bytes.data(), length, to, Tag);
  }
}

std::string Receive(vtkMultiProcessController* controller, int from)
{
  vtkIdType length = 0;
  controller->Receive(&length, 1, from, Tag);
  std::string bytes(static_cast<std::size_t>(length), '\0');
  if (length > 0)
  {
    controller->Receive(bytes.data(), length, from, Tag);
  }
  return bytes;
}
}

int Count()
{
  vtkMultiProcessController* controller = Controller();
  return controller ? controller->GetNumberOfProcesses() : 1;
}

int Own()
{
  vtkMultiProcessController* controller = Controller();
  return controller ? controller->GetLocalProcessId() : 0;
}

std::vector<int> ExchangeNumber(int number)
{
  std::vector<int> all(static_cast<std::size_t>(Count()), number);
  if (vtkMultiProcessController* controller = Controller())
  {
    AddToTraffic(sizeof(number));
    controller->AllGather(&number, all.data(), 1);
  }
  return all;
}

int SumBefore(int number)
{
  const std::vector<int> all = ExchangeNumber(number);
  return std::accumulate(all.begin(), all.begin() + Own(), 0);
}

std::vector<std::string> Exchange(const std::string& bytes)
{
  vtkMultiProcessController* controller = Controller();
  if (!controller)
  {
    return { bytes };
  }
  AddToTraffic(bytes.size());
  const auto count = static_cast<std::size_t>(Count());
  const auto length = static_cast<vtkIdType>(bytes.size());
  std::vector<vtkIdType> lengths(count);
  controller->AllGather(&length, lengths.data(), 1);
  std::vector<vtkIdType> offsets(count + 1);
  std::partial_sum(lengths.begin(), lengths.end(), offsets.begin() + 1);
  std::string all(static_cast<std::size_t>(offsets.back()), '\0');
  if (!all.empty())
  {
    controller->AllGatherV(bytes.data(), all.data(), length, lengths.data(), offsets.data());
  }
  std::vector<std::string> found;
  for (std::size_t i = 0; i < count; ++i)
  {
    found.push_back(
      all.substr(static_cast<std::size_t>(offsets[i]), static_cast<std::size_t>(lengths[i])));
  }
  return found;
}

std::vector<std::string> Collect(const std::string& bytes)
{
  vtkMultiProcessController* controller = Controller();
  if (!controller)
  {
    return { bytes };
  }
  std::vector<std::string> found;
  if (Own() != 0)
  {
    Send(controller, bytes, 0);
    return found;
  }
  found.push_back(bytes);
  for (int process = 1; process < Count(); ++process)
  {
    found.push_back(Receive(controller, process));
  }
  return found;
}

std::vector<std::string> Deal(std::vector<std::string> hands)
{
  vtkMultiProcessController* controller = Controller();
  // in every round each process has one partner at most; the lower one sends first
  for (int round = 0; controller && round < Count(); ++round)
  {
    const int partner = (round - Own() + Count()) % Count();
    if (partner != Own())
    {
      std::string& hand = hands[static_cast<std::size_t>(partner)];
      std::string received = Own() < partner ? std::string() : Receive(controller, partner);
      Send(controller, hand, partner);
      hand = Own() < partner ? Receive(controller, partner) : std::move(received);
    }
  }
  return hands;
}

std::string Broadcast(std::string bytes, int from)
{
  if (vtkMultiProcessController* controller = Controller())
  {
    AddToTraffic(from == Own() ? bytes.size() : 0);
    auto length = static_cast<vtkIdType>(bytes.size());
    controller->Broadcast(&length, 1, from);
    bytes.resize(static_cast<std::size_t>(length));
    if (length > 0)
    {
      controller->Broadcast(bytes.data(), length, from);
    }
  }
  return bytes;
}

Status Agree(const Status& own, int* speaker)
{
  if (Count() == 1)
  {
    return own;
  }
  const auto say = [speaker](int process)
  {
    if (speaker)
    {
      *speaker = process;
    }
  };
  // the code as a number, then the text
  const std::vector<std::string> all =
    Exchange(own ? std::string() : std::to_string(static_cast<int>(own.Code)) + " " + own.Detail);
  const auto hasText = [](const std::string& one) { return !one.empty() && one.back() != ' '; };
  auto found = std::find_if(all.begin(), all.end(), hasText);
  found = found != all.end()
    ? found
    : std::find_if(all.begin(), all.end(), [](const std::string& one) { return !one.empty(); });
  if (found != all.end())
  {
    const auto number = static_cast<int>(found - all.begin());
    say(number);
    const std::string text = found->substr(found->find(' ') + 1);
    const std::string place = " (process " + std::to_string(number) + " of " +
      std::to_string(Count()) + ", counted from 0)";
    // whoever agreed before has told the place
    const bool isPlaced = number == 0 || text.empty() || text.find(place) != std::string::npos;
    return { static_cast<ErrorCode>(std::stoi(*found)), isPlaced ? text : text + place };
  }
  say(0);
  return {};
}

Traffic TrafficSoFar()
{
  return Told;
}

Alone::Alone() : Before(vtkMultiProcessController::GetGlobalController())
{
  vtkMultiProcessController::SetGlobalController(nullptr);
}

Alone::~Alone()
{
  vtkMultiProcessController::SetGlobalController(this->Before);
}

Part PartOf(std::size_t n, int process, int count)
{
  const auto at = [n, count](int i)
  {
    const auto k = static_cast<std::size_t>(i);
    const auto parts = static_cast<std::size_t>(count);
    return n / parts * k + std::min(n % parts, k);
  };
  return { at(process), at(process + 1) };
}
}
