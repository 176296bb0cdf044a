"""The sidebar of the 3D view."""
import bpy

from . import hands, live, operators


class Panel(bpy.types.Panel):
    bl_idname, bl_label = "HANDHOLD_PT_grips", "Handhold"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Handhold"

    def draw(self, context) -> None:
        settings = context.scene.handhold
        layout = self.layout
        layout.prop(settings, "gripped")
        box = layout.box()
        box.prop(settings, "side", expand=True)
        box.label(text="Controller (profile)")
        box.prop(settings, "controllers", text="")
        box.operator(operators.AddHand.bl_idname, icon="VIEW_PAN")
        box.prop(settings, "shows_controllers")
        layout.operator(operators.CloseHand.bl_idname, icon="SNAP_ON")
        layout.prop(settings, "live", toggle=True, icon="SNAP_ON" if settings.live else "SNAP_OFF")
        if live.refused:
            layout.label(text=live.refused, icon="ERROR")
        box = layout.box()
        frame = context.scene.frame_current
        box.label(text={hands.RELEASED: "Frame 1: trigger released", hands.PRESSED: "Frame 11: trigger pressed"}.get(frame, f"Frame {frame}"))
        box.prop(settings, "finger")
        box.operator(operators.TriggerFinger.bl_idname)
        box.operator(operators.KeyPose.bl_idname, icon="KEY_HLT")
        box = layout.box()
        box.prop(settings, "mirror")
        box.operator(operators.MirrorHand.bl_idname, icon="MOD_MIRROR")
        box = layout.box()
        for name in ("name", "priority", "snap_radius_m", "snap_angle_deg", "file"):
            box.prop(settings, name)
        row = box.row(align=True)
        row.operator(operators.WriteGrip.bl_idname)
        row.operator(operators.ReadGrip.bl_idname)
        layout.operator(operators.CopyJoint.bl_idname)


def register() -> None:
    bpy.utils.register_class(Panel)


def unregister() -> None:
    bpy.utils.unregister_class(Panel)
