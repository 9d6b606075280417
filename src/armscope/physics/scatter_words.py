"""What is said of a joint that scatters, by the numbers that are known of it."""

from __future__ import annotations

SCATTER_CLAUSES = (
    "{location} scatters by {scatter}: play of {play}, if the rows stand in the order in which they were measured",
    "{location} scatters by {scatter}: after motion to one side and to the other it stands {overrun} apart, ahead "
    "of its readings, if rows were measured in this order",
    "{location} gives way under gravity by more in some rows than in others, by {give} (1 sigma), for a reason that no "
    "single column of the table tells",
    "{location} scatters as if what the arm carries changed from row to row by {unsaid_load} (1 sigma), and no column "
    "of the table tells",
    "{location} scatters by {scatter} for a reason that no single column of the table tells",
)
SCATTER_LABELS = {
    "scatter": "scatter (1 sigma)",
    "play": "play, by the order of rows",
    "overrun": "apart after motion to either side, by the order of rows",
    "give": "gives way by more or less (1 sigma)",
    "unsaid_load": "load that nobody recorded (1 sigma)",
}
