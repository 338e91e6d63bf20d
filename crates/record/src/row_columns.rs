//! Reading of rows from columns, the inverse of what `Columns::push` writes.

use super::columns::{Column, Columns};
use super::row::{FieldType, Row, TopicRow};
use crate::enum_label::LoggedEnum;

impl Columns {
    /// Reads the rows of a topic, each with its time (s), from columns of a log; `None` if a column is missing, as in logs of
    /// other versions.
    pub fn timed_rows<R: TopicRow>(&self) -> Option<Vec<(f64, R)>> {
        let times = self.numbers("time_s")?;
        let rows = R::read_rows(self, "")?;
        (rows.len() == times.len()).then(|| times.iter().copied().zip(rows).collect())
    }
}

/// Returns the values of a field, the name of which follows `before`.
pub(crate) fn values<T: FieldType>(
    columns: &Columns,
    before: &str,
    name: &str,
) -> Option<std::vec::IntoIter<T>> {
    let values = if before.is_empty() {
        T::read_column(columns, name)
    } else {
        T::read_column(columns, &format!("{before}{name}"))
    };
    values.map(Vec::into_iter)
}

/// Returns the nested rows of each row.
pub(crate) fn nested<R: Row>(columns: &Columns, name: &str) -> Option<Vec<Vec<R>>> {
    let Some(Column::Rows(counts, inner)) = columns.get(name) else { return None };
    let mut rows = R::read_rows(inner, "")?.into_iter();
    Some(counts.iter().map(|count| rows.by_ref().take(*count as usize).collect()).collect())
}

/// Returns the values of an enumeration; `None` if a row has another label.
pub(crate) fn labels<T: Copy>(
    columns: &Columns,
    name: &str,
    labels: &LoggedEnum,
    values: &[T],
) -> Option<Vec<T>> {
    let Some(Column::Labels(indices, names)) = columns.get(name) else { return None };
    let value = |name: &String| {
        let place = labels.values.iter().position(|label| label == name)?;
        values.get(place).copied()
    };
    let known: Vec<Option<T>> = names.iter().map(value).collect();
    indices.iter().map(|index| known.get(usize::from(*index)).copied().flatten()).collect()
}

/// Returns dates or time spans in nanoseconds, to the precision of their seconds.
pub(crate) fn nanoseconds(columns: &Columns, name: &str) -> Option<impl Iterator<Item = u64>> {
    Some(columns.numbers(name)?.iter().map(|seconds| (seconds * 1e9).round() as u64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hinges, Jets, Metric, Metrics, Orbit, OrbitAxis, Torque, Torques};
    use crate::{Light, states::Sliding};

    /// Returns the columns of rows, with times 0, 1, 2 and so on.
    fn columns<R: TopicRow>(rows: &[R]) -> Columns {
        let mut columns = Columns::new(R::FIELDS);
        rows.iter().for_each(|row| columns.push(row));
        let times = (0..rows.len()).map(|index| index as f64).collect();
        columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
        columns
    }

    fn read_back<R: TopicRow + Clone + PartialEq + std::fmt::Debug>(rows: &[R]) {
        let expected: Vec<(f64, R)> =
            rows.iter().enumerate().map(|(index, row)| (index as f64, row.clone())).collect();
        assert_eq!(columns(rows).timed_rows::<R>(), Some(expected));
    }

    #[test]
    fn rows_are_read_as_they_were_written() {
        let jets = |fuel_kg| Jets { roll_on_s: 0.1, pitch_on_s: -0.2, yaw_on_s: 0.0, fuel_kg };
        read_back(&[jets(0.5), jets(1.5)]);
        let torque =
            |applied_nm| Torque { feedforward_nm: 0.0, feedback_nm: 1.0, applied_nm, disturbance_nm: 3.0 };
        read_back(&[Torques { axes: vec![torque(1.0), torque(2.0)] }, Torques { axes: Vec::new() }]);
        let axis = OrbitAxis { position_m: 1.0, velocity_m_s: 2.0, nadir: 3.0, field_t: 4.0, sun: 5.0 };
        let orbit = |light| Orbit { axes: vec![axis.clone(); 3], light, sunlight: 0.5 };
        read_back(&[orbit(Light::Lit), orbit(Light::Shadow)]);
        let metric = |name: &str, index| Metric {
            name: name.to_owned(),
            unit: String::new(),
            index,
            value: 1.0,
            text: "met".to_owned(),
        };
        read_back(&[Metrics { metrics: vec![metric("a", 0), metric("a", 1)] }]);
        read_back::<Hinges>(&[]);
    }

    #[test]
    fn columns_of_another_form_are_no_rows() {
        let whole = columns(&[Torques { axes: Vec::new() }]);
        assert!(whole.timed_rows::<Jets>().is_none());
        let foreign = Columns {
            columns: vec![(
                "sliding".to_owned(),
                Column::Labels(vec![1], vec!["stuck".into(), "gone".into()]),
            )],
        };
        assert_eq!(labels(&foreign, "sliding", &Sliding::LABELS, Sliding::VALUES), None);
    }
}
