//! What a comparison found, as a part of a report.

use turnpath_report as report;
use turnpath_verify::{
    Anomaly, AnomalyDetector, AnomalyKind, Column, ComparisonFigures, RowAnomaly, RowFault,
};

/// The rows that are not as the recipe gives them.
pub fn of_rows(figures: ComparisonFigures) -> report::Anomalies {
    report::Anomalies {
        compared_with: report::Standard::Recipe,
        not_compared_because: None,
        count: figures.count,
        places: figures.worst.into_iter().map(of_row).collect(),
    }
}

/// The points that stand out among their neighbours, and why the rows were not compared with those of
/// the recipe.
pub fn of_neighbours(detector: Option<AnomalyDetector>, reason: String) -> report::Anomalies {
    let (count, found) = detector.map(AnomalyDetector::finish).unwrap_or_default();
    report::Anomalies {
        compared_with: report::Standard::Neighbours,
        not_compared_because: Some(reason),
        count,
        places: found.into_iter().map(of_neighbour).collect(),
    }
}

fn of_row(anomaly: RowAnomaly) -> report::Anomaly {
    let (kind, columns) = match anomaly.fault {
        RowFault::Lost => (report::AnomalyKind::RowLost, Vec::new()),
        RowFault::Added => (report::AnomalyKind::RowAdded, Vec::new()),
        RowFault::Differs(columns) => (report::AnomalyKind::RowDiffers, columns),
    };
    report::Anomaly {
        point: anomaly.row,
        at: report::PathPlace {
            c: anomaly.c,
            x: anomaly.x,
        },
        kind,
        columns: columns.into_iter().map(column).collect(),
        by: anomaly.worth,
        neighbours: None,
    }
}

fn column(column: Column) -> report::Column {
    match column {
        Column::Time => report::Column::Time,
        Column::C => report::Column::C,
        Column::X => report::Column::X,
        Column::Z => report::Column::Z,
        Column::Vc => report::Column::Vc,
        Column::Vx => report::Column::Vx,
        Column::Vz => report::Column::Vz,
        Column::Section => report::Column::Section,
    }
}

fn of_neighbour(anomaly: Anomaly) -> report::Anomaly {
    report::Anomaly {
        point: anomaly.point,
        at: report::PathPlace {
            c: anomaly.c,
            x: anomaly.x,
        },
        kind: match anomaly.kind {
            AnomalyKind::Height => report::AnomalyKind::ZPosition,
            AnomalyKind::MotionOfC => report::AnomalyKind::CMotion,
            AnomalyKind::MotionOfX => report::AnomalyKind::XMotion,
            AnomalyKind::MotionOfZ => report::AnomalyKind::ZMotion,
            AnomalyKind::Gap => report::AnomalyKind::Gap,
        },
        columns: Vec::new(),
        by: anomaly.amount,
        neighbours: Some(anomaly.usual),
    }
}
