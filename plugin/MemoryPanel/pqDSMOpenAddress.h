// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMOpenAddress_h
#define pqDSMOpenAddress_h

#include <QActionGroup>

/// File > Open URL...: asks for the address of a Zarr volume, and creates a DSM Volume Reader for it. ParaView's own
/// dialog of files knows paths only. The application's thread.
class pqDSMOpenAddress : public QActionGroup
{
  Q_OBJECT

public:
  explicit pqDSMOpenAddress(QObject* parent = nullptr);

private:
  void Ask();
};

#endif
