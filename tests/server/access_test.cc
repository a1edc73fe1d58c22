// Scopes, places and accounts of clients. What tokens and metadata do is shown
// over the network (tests/integration/security_test.py).
#include "server/service/access.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <thread>
#include <vector>

#include "terrane/v1/flower.pb.h"
#include "terrane/v1/info.pb.h"
#include "terrane/v1/raster.pb.h"
#include "terrane/v1/render.pb.h"
#include "terrane/v1/spot_table.pb.h"
#include "terrane/v1/surface.pb.h"
#include "terrane/v1/terrain.pb.h"
#include "terrane/v1/tree.pb.h"

namespace terrane::server {
namespace {

TEST(ScopeOf, EveryMethodHasOneAndANameOfItsOwn) {
  std::set<std::string> names;
  for (const google::protobuf::Descriptor* message :
       {v1::StreamFlowerRequest::descriptor(),
        v1::GetServerInfoRequest::descriptor(),
        v1::UploadRasterRequest::descriptor(),
        v1::StreamRenderRequest::descriptor(),
        v1::UploadSpotTableRequest::descriptor(),
        v1::StreamSurfaceRequest::descriptor(),
        v1::StreamTilesRequest::descriptor(),
        v1::StreamTreeRequest::descriptor()}) {
    const google::protobuf::FileDescriptor* file = message->file();
    ASSERT_EQ(file->service_count(), 1) << file->name();
    for (int i = 0; i < file->service(0)->method_count(); ++i) {
      const std::string name = file->service(0)->method(i)->name();
      EXPECT_TRUE(names.insert(name).second) << name;
      EXPECT_TRUE(ScopeOf(name).has_value()) << name;
    }
  }
  EXPECT_FALSE(ScopeOf("NoSuchMethod").has_value());
}

TEST(ClientPlaces, AreCountedByClientAndComeBack) {
  ClientPlaces places(2);
  auto first = places.Take("sub:alice");
  const auto second = places.Take("sub:alice");
  EXPECT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(places.Take("sub:alice"), nullptr);
  EXPECT_NE(places.Take("sub:bob"), nullptr);
  const auto copy = first;
  first.reset();
  EXPECT_EQ(places.Take("sub:alice"), nullptr) << "a copy holds the place";
}

TEST(ClientPlaces, MayOutliveTheirCounter) {
  std::shared_ptr<const void> place;
  {
    ClientPlaces places(1);
    place = places.Take("ipv4:127.0.0.1");
    ASSERT_NE(place, nullptr);
  }
  place.reset();
}

TEST(ClientPlaces, NoneIsLostBetweenThreads) {
  ClientPlaces places(1);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&places] {
      for (int k = 0; k < 10'000; ++k) places.Take("sub:alice");
    });
  }
  for (std::thread& thread : threads) thread.join();
  const auto last = places.Take("sub:alice");
  EXPECT_NE(last, nullptr);
}

using Seconds = ClientAccounts::Seconds;

// A time as good as any.
constexpr ClientAccounts::Time kStart{Seconds(1000)};

TEST(ClientAccounts, HoldWhatComesInTenSecondsAndFillAgain) {
  ClientAccounts accounts(2);
  for (int k = 0; k < 20; ++k) {
    EXPECT_EQ(accounts.Wait("sub:alice", kStart), Seconds(0)) << k;
    accounts.Charge("sub:alice", 1, kStart);
  }
  accounts.Charge("sub:alice", 1, kStart);
  EXPECT_EQ(accounts.Wait("sub:alice", kStart), Seconds(0.5));
  EXPECT_EQ(accounts.Wait("sub:bob", kStart), Seconds(0));
  EXPECT_EQ(accounts.Wait("sub:alice", kStart + Seconds(0.5)), Seconds(0));
  // Who keeps still saves no more than that.
  const ClientAccounts::Time later = kStart + Seconds(1e6);
  accounts.Charge("sub:alice", 22, later);
  EXPECT_EQ(accounts.Wait("sub:alice", later), Seconds(1));
}

TEST(ClientAccounts, ADebtIsPaidBeforeAnythingElse) {
  ClientAccounts accounts(0.25);
  accounts.Charge("sub:alice", 60, kStart);
  EXPECT_EQ(accounts.Wait("sub:alice", kStart), Seconds(230));
  EXPECT_EQ(accounts.Wait("sub:alice", kStart + Seconds(229)), Seconds(1));
}

TEST(ClientAccounts, WhatIsGivenBackMayBeUsedAgain) {
  ClientAccounts accounts(1);
  accounts.Charge("sub:alice", 10, kStart);
  accounts.Charge("sub:alice", 1, kStart);
  EXPECT_EQ(accounts.Wait("sub:alice", kStart), Seconds(1));
  accounts.Charge("sub:alice", -1, kStart);
  EXPECT_EQ(accounts.Wait("sub:alice", kStart), Seconds(0));
  // A full account holds no more for it.
  accounts.Charge("sub:bob", -5, kStart);
  accounts.Charge("sub:bob", 11, kStart);
  EXPECT_EQ(accounts.Wait("sub:bob", kStart), Seconds(1));
}

TEST(ClientAccounts, OfThoseThatAreFullHardlyAnyIsKept) {
  ClientAccounts accounts(10);
  accounts.Charge("debtor", 1000, kStart);
  for (int k = 0; k < 50'000; ++k) {
    // A thousand new clients a second, each in need of a tenth of one.
    accounts.Charge(std::to_string(k), 1, kStart + Seconds(k * 1e-3));
    ASSERT_LT(accounts.size(), 1100U);
  }
  EXPECT_EQ(accounts.Wait("debtor", kStart + Seconds(50)), Seconds(40));
}

}  // namespace
}  // namespace terrane::server
