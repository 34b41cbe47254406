// SPDX-License-Identifier: BSD-3-Clause
/**
 * The menu Knotwork of ParaView's window: examples, steps that ParaView needs several of its own
 * for, and the pages. It also brings the help and the colour maps, so that these come with the
 * window alone, not with pvserver or pvbatch.
 */
#ifndef KnotworkMenu_h
#define KnotworkMenu_h
#include <QActionGroup>

class QMenu;

class KnotworkMenu : public QActionGroup
{
  Q_OBJECT

public:
  explicit KnotworkMenu(QObject* parent);
  ~KnotworkMenu() override;

private:
  Q_DISABLE_COPY(KnotworkMenu)

  QMenu* Examples;
};
#endif
