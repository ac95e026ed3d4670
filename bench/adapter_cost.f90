!> What an adapter adds to the routine: UMAT of CalculiX and of Kratos against `friction_update` on
!> the same increments, in one run. Prints nanoseconds a call, and their ratio.
program adapter_cost
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_update
    use host_calls, only : call_host
    implicit none
    real(dp), parameter :: props(8) = [1.0_dp, 1000.0_dp, 800.0_dp, 0.45_dp, 0.25_dp, 8.0_dp, &
        0.2_dp, 60.0_dp], thickness = 0.1_dp
    integer, parameter :: calls = 20000, rounds = 99
    real(dp) :: routine, adapter
    integer :: round

    routine = huge(routine)
    adapter = huge(adapter)
    do round = 1, rounds   ! the least processor time of many: whatever else runs only adds
        routine = min(routine, time_routine())
        adapter = min(adapter, time_adapter())
    end do
    print '(a, f8.1, a, f8.1, a, f6.2)', 'friction_update ', routine, ' ns, UMAT ', adapter, &
        ' ns a call: ratio ', adapter / routine

contains

    !> Pressed, then sheared back and forth: stick and slip in turn.
    pure function increment(k) result(du)
        integer, intent(in) :: k
        real(dp) :: du(3)

        du = [0.0_dp, 1.0e-4_dp, 2.0e-5_dp]
        if (mod(k / 20, 2) == 1) du = -du
        if (k == 1) du(1) = -3.0e-3_dp
    end function increment

    function time_routine() result(nanoseconds)
        real(dp) :: nanoseconds, statev(8), traction(3), tangent(3, 3), start, finish
        integer :: k, status

        statev = 0.0_dp
        call cpu_time(start)
        do k = 1, calls
            call friction_update(increment(k), 0.01_dp, props, statev, traction, tangent, status)
        end do
        call cpu_time(finish)
        nanoseconds = 1.0e9_dp * (finish - start) / calls
    end function time_routine

    function time_adapter() result(nanoseconds)
        real(dp) :: nanoseconds, statev(8), stress(6), ddsdde(6, 6), strain(6), du(3), &
            start, finish
        integer :: k

        statev = 0.0_dp
        stress = 0.0_dp
        strain = 0.0_dp
        call cpu_time(start)
        do k = 1, calls
            du = increment(k) / thickness
            strain(3) = du(1)
            strain(5) = du(2)
            strain(6) = du(3)
            call call_host([thickness, 1.0_dp, props], 0.01_dp, strain, statev, stress, ddsdde)
        end do
        call cpu_time(finish)
        nanoseconds = 1.0e9_dp * (finish - start) / calls
    end function time_adapter

end program adapter_cost
