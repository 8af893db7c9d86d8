// SPDX-License-Identifier: Apache-2.0
#include "server/quota/quotas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

TEST(Quotas, HaveDefaultsByRole) {
  const QuotaTable table;
  EXPECT_EQ(table.Of(Role::kStudent).jobs, 100u);
  EXPECT_EQ(table.Of(Role::kStudent).cpu_seconds, 7200);
  EXPECT_EQ(table.Of(Role::kStudent).watches, 8u);
  EXPECT_EQ(table.Of(Role::kStudent).storage_bytes, 512u << 20);
  EXPECT_EQ(table.Of(Role::kStudent).requests, 50);
  EXPECT_FALSE(table.Of(Role::kGrader).cpu_seconds);
  const Quotas& admin = table.Of(Role::kAdmin);
  EXPECT_FALSE(admin.jobs || admin.cpu_seconds || admin.watches || admin.storage_bytes || admin.requests);
}

TEST(Quotas, AreSetOneByOne) {
  QuotaTable table;
  for (const char* text : {"student.jobs=7", "student.cpu-seconds=0.5", "grader.watches=none", "student.storage-mib=3",
                           "admin.requests=2.5"}) {
    EXPECT_THAT(table.Set(text), IsOk()) << text;
  }
  EXPECT_EQ(table.Of(Role::kStudent).jobs, 7u);
  EXPECT_EQ(table.Of(Role::kStudent).cpu_seconds, 0.5);
  EXPECT_EQ(table.Of(Role::kStudent).storage_bytes, 3u << 20);
  EXPECT_EQ(table.Of(Role::kStudent).watches, 8u);
  EXPECT_FALSE(table.Of(Role::kGrader).watches);
  EXPECT_EQ(table.Of(Role::kAdmin).requests, 2.5);
}

TEST(Quotas, WhatIsNoneIsSaid) {
  QuotaTable table;
  const auto refused = [&](const char* text, const char* what) {
    EXPECT_THAT(table.Set(text), StatusIs(absl::StatusCode::kInvalidArgument, AllOf(HasSubstr(text), HasSubstr(what))));
  };
  refused("student", "ROLE.LIMIT=VALUE");
  refused("student=3.jobs", "ROLE.LIMIT=VALUE");
  refused("teacher.jobs=3", "allowed: student, grader, instructor, admin");
  refused("student.disk=3", "allowed: jobs, cpu-seconds, watches, storage-mib, requests");
  for (const char* bad : {"0", "-1", "1.5", "", "1x", "nan", "inf", "4294967296"}) {
    refused(("student.jobs=" + std::string(bad)).c_str(), "a whole number greater than 0, at most 4294967295");
  }
  refused("student.requests=1e7", "a number greater than 0, at most 1000000");
  EXPECT_EQ(table.Of(Role::kStudent).jobs, 100u);
}

}  // namespace
}  // namespace flatlight
