"""Ranges, places, fields, wrenches and contacts as messages."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.nodes.gazebo_ros._conversion import Outgoing, header, named, vector
from daidalos.samples import sensors as samples

_range_type = named("sensor_msgs", "Range")
_navsat_type = named("sensor_msgs", "NavSatFix")
_magnetic_type = named("sensor_msgs", "MagneticField")
_pressure_type = named("sensor_msgs", "FluidPressure")
_altimeter_type = named("ros_gz_interfaces", "Altimeter")
_wrench_type = named("geometry_msgs", "WrenchStamped")
_contacts_type = named("ros_gz_interfaces", "Contacts")
_bumper_type = named("gazebo_msgs", "ContactsState")
_flag_type = named("std_msgs", "Bool")
_number_type = named("std_msgs", "Float32")
_text_type = named("std_msgs", "String")
_battery_type = named("sensor_msgs", "BatteryState")
_wheel_slip_type = named("gazebo_msgs", "WheelSlip")


def _range(sample: samples.RangeSample) -> Any:
    cls = _range_type()
    return cls(
        header=header(sample),
        radiation_type=cls.ULTRASOUND if sample.ultrasound else cls.INFRARED,
        field_of_view=sample.field_of_view,
        min_range=sample.range_min,
        max_range=sample.range_max,
        range=sample.range,
    )


def _navsat(sample: samples.NavSatSample) -> Any:
    from sensor_msgs.msg import NavSatStatus

    cls = _navsat_type()
    known = bool(sample.covariance.any())
    return cls(
        header=header(sample),
        status=NavSatStatus(status=NavSatStatus.STATUS_FIX, service=NavSatStatus.SERVICE_GPS),
        latitude=sample.latitude,
        longitude=sample.longitude,
        altitude=sample.altitude,
        position_covariance=sample.covariance,
        position_covariance_type=cls.COVARIANCE_TYPE_DIAGONAL_KNOWN if known else cls.COVARIANCE_TYPE_UNKNOWN,
    )


def _magnetic(sample: samples.MagneticFieldSample) -> Any:
    return _magnetic_type()(
        header=header(sample), magnetic_field=vector(sample.field), magnetic_field_covariance=sample.covariance
    )


def _pressure(sample: samples.PressureSample) -> Any:
    return _pressure_type()(header=header(sample), fluid_pressure=sample.pressure, variance=sample.variance)


def _altimeter(sample: samples.AltimeterSample) -> Any:
    return _altimeter_type()(
        header=header(sample),
        vertical_position=sample.position,
        vertical_velocity=sample.velocity,
        vertical_reference=sample.reference,
    )


def _wrench(sample: samples.WrenchSample) -> Any:
    from geometry_msgs.msg import Wrench

    wrench = Wrench(force=vector(sample.force), torque=vector(sample.torque))
    return _wrench_type()(header=header(sample), wrench=wrench)


def _contacts(sample: samples.ContactsSample) -> Any:
    from geometry_msgs.msg import Wrench
    from ros_gz_interfaces.msg import Contact, Entity, JointWrench

    def entity(model: str, link: str, collision: str) -> Any:
        return Entity(name=f"{model}::{link}::{collision}", type=Entity.COLLISION)

    contacts = [
        Contact(
            collision1=entity(contact.model1, contact.link1, contact.collision1),
            collision2=entity(contact.model2, contact.link2, contact.collision2),
            positions=[vector(row) for row in contact.positions],
            normals=[vector(row) for row in contact.normals],
            depths=contact.depths,
            wrenches=[
                JointWrench(body_1_wrench=Wrench(force=vector(-force)), body_2_wrench=Wrench(force=vector(force)))
                for force in contact.forces
            ],
        )
        for contact in sample.contacts
    ]
    return _contacts_type()(header=header(sample), contacts=contacts)


def _bumper(sample: samples.BumperSample) -> Any:
    from gazebo_msgs.msg import ContactState
    from geometry_msgs.msg import Wrench

    states = []
    for contact in sample.contacts:
        first = f"{contact.model1}::{contact.link1}::{contact.collision1}"
        second = f"{contact.model2}::{contact.link2}::{contact.collision2}"
        states.append(
            ContactState(
                info=f"{first} touches {second} at {sample.stamp_ns * 1e-9:.3f} s",
                collision1_name=first,
                collision2_name=second,
                wrenches=[Wrench(force=vector(-force)) for force in contact.forces],
                total_wrench=Wrench(force=vector(-np.sum(contact.forces, axis=0))),
                contact_positions=[vector(row) for row in contact.positions],
                contact_normals=[vector(row) for row in contact.normals],
                depths=contact.depths,
            )
        )
    return _bumper_type()(header=header(sample), states=states)


def _flag(sample: samples.FlagSample) -> Any:
    return _flag_type()(data=sample.value)


def _number(sample: samples.NumberSample) -> Any:
    return _number_type()(data=sample.value)


def _text(sample: samples.TextSample) -> Any:
    return _text_type()(data=sample.text)


def _battery(sample: samples.BatterySample) -> Any:
    cls = _battery_type()
    charging = cls.POWER_SUPPLY_STATUS_CHARGING if sample.current > 0 else cls.POWER_SUPPLY_STATUS_DISCHARGING
    return cls(
        header=header(sample),
        voltage=sample.voltage,
        current=sample.current,
        charge=sample.charge,
        capacity=sample.capacity,
        design_capacity=sample.capacity,
        percentage=sample.charge / sample.capacity,
        temperature=math.nan,
        power_supply_status=charging,
        present=True,
    )


def _wheel_slip(sample: samples.WheelSlipSample) -> Any:
    return _wheel_slip_type()(
        name=list(sample.names), lateral_slip=sample.lateral.tolist(), longitudinal_slip=sample.longitudinal.tolist()
    )


SENSORS: dict[type[samples.Sample], Outgoing] = {
    samples.RangeSample: Outgoing(_range_type, _range),
    samples.NavSatSample: Outgoing(_navsat_type, _navsat),
    samples.MagneticFieldSample: Outgoing(_magnetic_type, _magnetic),
    samples.PressureSample: Outgoing(_pressure_type, _pressure),
    samples.AltimeterSample: Outgoing(_altimeter_type, _altimeter),
    samples.WrenchSample: Outgoing(_wrench_type, _wrench),
    samples.ContactsSample: Outgoing(_contacts_type, _contacts),
    samples.BumperSample: Outgoing(_bumper_type, _bumper),
    samples.FlagSample: Outgoing(_flag_type, _flag),
    samples.NumberSample: Outgoing(_number_type, _number),
    samples.TextSample: Outgoing(_text_type, _text),
    samples.BatterySample: Outgoing(_battery_type, _battery),
    samples.WheelSlipSample: Outgoing(_wheel_slip_type, _wheel_slip),
}
