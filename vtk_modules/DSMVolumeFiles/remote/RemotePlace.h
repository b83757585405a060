// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_RemotePlace_h
#define vol_RemotePlace_h

#include <string>

namespace vol
{

/// Where requests for the keys of a store go. The store is named by its address: http, https, or s3://bucket/key.
class RemotePlace
{
public:
  /// Throws dsm::Error when the address cannot be used: another scheme, a password, a query. `url` has no '/' at its
  /// end.
  explicit RemotePlace(const std::string& url);

  /// The store's address, as the user gave it.
  const std::string& GetRoot() const { return this->Root; }
  /// Returns the address that a request for a key goes to; the key's path begins with the store's address, or with
  /// that of the folder around it.
  std::string GetAddress(const std::string& path) const;

  /// How requests are signed; an empty Key: they are not.
  struct Signature
  {
    std::string Region;
    std::string Key;
    std::string Secret;
    std::string Token; ///< of a session; may be empty
  };
  const Signature& GetSignature() const { return this->Signing; }

private:
  void FindBucket(const std::string& rest);

  std::string Root;
  std::string Address; ///< of what Root's part up to Split names
  std::size_t Split;   ///< bytes of Root that Address stands for
  Signature Signing;
};

} // namespace vol

#endif
