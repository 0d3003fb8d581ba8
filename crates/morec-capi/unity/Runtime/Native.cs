// Made from include/morec.h, where everything is described: `MOREC_WRITE_HEADER=1 cargo test -p morec-capi` makes it again.
using System;
using System.Runtime.InteropServices;

namespace Morec
{
    public enum MorecStatus
    {
        Ok = 0,
        NullPointer = 1,
        BadHandle = 2,
        InvalidValue = 3,
        BufferTooSmall = 4,
        Busy = 5,
        QueueFull = 6,
        File = 7,
        BadIndex = 8,
        NothingInCommon = 9,
        WrongOrder = 10,
        StructSize = 11,
        Internal = 12,
    }

    public enum MorecRole
    {
        None = -1,
        Hips = 0,
        LeftThigh = 1,
        LeftShin = 2,
        LeftFoot = 3,
        RightThigh = 4,
        RightShin = 5,
        RightFoot = 6,
        Torso = 7,
        Neck = 8,
        Head = 9,
        LeftShoulder = 10,
        LeftArm = 11,
        LeftForearm = 12,
        LeftHand = 13,
        RightShoulder = 14,
        RightArm = 15,
        RightForearm = 16,
        RightHand = 17,
    }

    public enum MorecHandedness
    {
        Unknown = 0,
        Right = 1,
        Left = 2,
    }

    public enum MorecUpAxis
    {
        Y = 0,
        Z = 1,
    }

    public enum MorecSpace
    {
        Unknown = 0,
        World = 1,
        Local = 2,
    }

    public enum MorecPhase
    {
        Start = 0,
        Update = 1,
        Cancel = 2,
        End = 3,
        Repetition = 4,
        Progress = 5,
    }

    public enum MorecMethod
    {
        Templates = 0,
        Svrdm = 1,
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecDiagnosis
    {
        public UIntPtr struct_size;
        public ulong frames;
        public uint findings;
        public int severity;
        public uint missing_roles;
        public uint flickering_roles;
        public double secs;
        public double rate_hz;
        public double jitter_secs;
        public double lost_share;
        public double repeated_share;
        public double empty_share;
        public double height_m;
        public double leg_m;
        public double tilt_rad;
        public double noise_m;
        public double spike_share;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecIndexFacts
    {
        public UIntPtr struct_size;
        public uint class_count;
        public uint roles;
        public ulong sample_count;
        public double tick_hz;
        public int method;
        public uint needs_rotations;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecSkeleton
    {
        public UIntPtr struct_size;
        public UIntPtr joint_count;
        public IntPtr parents;
        public IntPtr names;
        public IntPtr offsets;
        public IntPtr roles;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecOptions
    {
        public UIntPtr struct_size;
        public int handedness;
        public int up_axis;
        public IntPtr skeleton;
        public uint roles;
        public uint flags;
        public UIntPtr event_capacity;
        public double refractory_secs;
        public double sensitivity;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecFrame
    {
        public UIntPtr struct_size;
        public double time_secs;
        public UIntPtr joint_count;
        public IntPtr positions;
        public IntPtr rotations;
        public int space;
        public uint reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecEvent
    {
        public int phase;
        public uint class_id;
        public ulong motion;
        public ulong sequence;
        public double score;
        public double progress;
        public double start_secs;
        public double stop_secs;
        public double reported_secs;
        public double wall_secs;
        public uint repetitions;
        public double period_secs;
        public double off_degrees;
        public double pace;
        public uint worst_bone;
        public double worst_degrees;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct MorecStats
    {
        public UIntPtr struct_size;
        public ulong frames;
        public ulong refused_frames;
        public ulong events;
        public ulong lost_events;
        public ulong suppressed_motions;
        public double latency_secs;
    }

    public static class Native
    {
#if UNITY_IOS && !UNITY_EDITOR
        const string Library = "__Internal";
#else
        const string Library = "morec_capi";
#endif

        public const int MOREC_TENTATIVE = 1;
        public const int MOREC_PERFORMER_ANYONE = 2;
        public const int MOREC_PERFORMER_TEACHER = 4;
        public const int MOREC_EACH_REPETITION = 8;
        public const int MOREC_DEVIATION = 16;
        public const int MOREC_PROGRESS = 32;
        public const int MOREC_ROLE_COUNT = 18;
        public const int MOREC_POINT_COUNT = 85;
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_diagnosis(IntPtr recognizer, ref MorecDiagnosis diagnosis);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_diagnosis_text(IntPtr recognizer, byte[] buffer, UIntPtr size, out UIntPtr needed);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_bone_name(uint bone, byte[] buffer, UIntPtr size, out UIntPtr needed);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_index_load(byte[] path, out IntPtr index);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_index_from_memory(byte[] bytes, UIntPtr size, out IntPtr index);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_index_destroy(IntPtr index);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_index_facts(IntPtr index, ref MorecIndexFacts facts);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_index_class_name(IntPtr index, uint class_id, byte[] buffer, UIntPtr size, out UIntPtr needed);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_create(IntPtr index, ref MorecOptions options, out IntPtr recognizer);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_destroy(IntPtr recognizer);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_joint_of_role(IntPtr recognizer, int role, out int joint);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_push(IntPtr recognizer, ref MorecFrame frame);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_poll(IntPtr recognizer, [In, Out] MorecEvent[] events, UIntPtr event_size, UIntPtr capacity, out UIntPtr count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_finish(IntPtr recognizer);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_reset(IntPtr recognizer);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern MorecStatus morec_recognizer_stats(IntPtr recognizer, ref MorecStats stats);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr morec_last_error();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr morec_status_text(int status);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr morec_version();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr morec_role_name(int role);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int morec_role_from_name(byte[] name);

        public static UIntPtr SizeOf<T>() { return (UIntPtr)Marshal.SizeOf(typeof(T)); }
    }
}
