!> The contact as a thin layer of elements: gap = thickness * strain, traction = stress. What the
!> UMATs of Abaqus and CalculiX share.
module friction_layer
    use, intrinsic :: iso_fortran_env, only : int64
    use friction_host, only : elastic_energy, host_update
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_property, friction_bad_size, statev_dissipation, &
        statev_size, statev_u_et, statev_u_n
    implicit none
    private

    public :: layer_update

    !> Places in the host's list of constants.
    integer, parameter :: at_thickness = 1, at_modulus = 2, at_friction = 3

    !> Where the components of the traction stand in the host's stress.
    type :: layer_components
        integer :: n = 0              !! components of the traction, 2 or 3
        integer :: place(3) = 0       !! normal, tangential 1 and 2
        integer :: direct(2) = 0      !! stresses in the layer's plane; 0 for none
        integer :: shear = 0          !! shear stress in the layer's plane; 0 for none
    end type layer_components

contains

    !> Stress and stiffness of a layer element from a strain increment.
    !>
    !> The layer's normal is axis 3 of a solid, axis 2 in plane strain, the first component of a
    !> cohesive element. In its plane the layer is elastic and does not contract sideways.
    pure subroutine layer_update(ndi, nshr, props, dstran, dtime, statev, stress, ddsdde, sse, &
        spd, status)
        integer, intent(in) :: ndi, nshr            !! direct and shear components of the host
        real(wp), intent(in) :: props(:)   !! thickness [L], modulus [F/L^2], friction constants
        real(wp), intent(in) :: dstran(:)           !! strain increment, engineering shear [-]
        real(wp), intent(in) :: dtime               !! [T]
        real(wp), intent(inout) :: statev(:)        !! state of the friction routine
        real(wp), intent(inout) :: stress(:)        !! start in, end out; tension positive [F/L^2]
        real(wp), intent(inout) :: ddsdde(:, :)     !! d(stress)/d(dstran) [F/L^2]
        real(wp), intent(inout) :: sse, spd   !! energy per volume: elastic, dissipated [F/L^2]
        integer, intent(out) :: status              !! of the friction routine
        type(layer_components) :: at
        real(wp) :: traction(3), tangent(3, 3), thickness, modulus
        integer :: n

        status = friction_bad_size
        at = components(ndi, nshr)
        n = at%n
        if (n == 0 .or. size(props) < at_friction .or. size(statev) < statev_size) return
        status = friction_bad_property
        if (.not. (is_finite(props(at_thickness)) .and. is_finite(props(at_modulus)))) return
        thickness = props(at_thickness)
        modulus = props(at_modulus)
        if (thickness <= 0.0_wp .or. modulus < 0.0_wp) return

        call host_update(thickness * dstran(at%place(1:n)), dtime, props(at_friction:), statev, &
            traction(1:n), tangent(1:n, 1:n), status)
        if (status < 0) return
        call extend_in_plane(at, modulus, dstran, stress, ddsdde, sse)
        stress(at%place(1:n)) = traction(1:n)
        ddsdde(at%place(1:n), at%place(1:n)) = thickness * tangent(1:n, 1:n)
        sse = sse + elastic_energy(props(at_friction:), statev(statev_u_n), &
            statev(statev_u_et:statev_u_et + n - 2)) / thickness
        spd = statev(statev_dissipation) / thickness
    end subroutine layer_update

    !> Read from the exponent, so that a NaN raises no exception in the host.
    pure function is_finite(x) result(finite)
        real(wp), intent(in) :: x
        logical :: finite
        integer(int64), parameter :: exponent_bits = shiftl(2047_int64, 52)

        finite = iand(transfer(x, exponent_bits), exponent_bits) /= exponent_bits
    end function is_finite

    !> Elastic stresses in the plane of the layer; everything else of the stiffness is set to zero.
    pure subroutine extend_in_plane(at, modulus, dstran, stress, ddsdde, energy)
        type(layer_components), intent(in) :: at
        real(wp), intent(in) :: modulus             !! [F/L^2]
        real(wp), intent(in) :: dstran(:)
        real(wp), intent(inout) :: stress(:), ddsdde(:, :)
        real(wp), intent(out) :: energy             !! elastic, per volume [F/L^2]
        integer :: places(3), i, k
        real(wp) :: stiffness(3)

        places = [at%direct, at%shear]
        stiffness = modulus * [1.0_wp, 1.0_wp, 0.5_wp]
        ddsdde = 0.0_wp
        energy = 0.0_wp
        if (.not. modulus > 0.0_wp) return
        do k = 1, size(places)
            i = places(k)
            if (i == 0) cycle
            stress(i) = stress(i) + stiffness(k) * dstran(i)
            ddsdde(i, i) = stiffness(k)
            energy = energy + 0.5_wp * stress(i)**2 / stiffness(k)
        end do
    end subroutine extend_in_plane

    pure function components(ndi, nshr) result(at)
        integer, intent(in) :: ndi, nshr
        type(layer_components) :: at

        if (ndi == 3 .and. nshr == 3) then        ! solid: 11, 22, 33, 12, 13, 23
            at = layer_components(3, [3, 5, 6], [1, 2], 4)
        else if (ndi == 3 .and. nshr == 1) then   ! plane strain: 11, 22, 33, 12
            at = layer_components(2, [2, 4, 0], [1, 3], 0)
        else if (ndi == 1 .and. nshr == 2) then   ! cohesive element in space
            at = layer_components(3, [1, 2, 3], [0, 0], 0)
        else if (ndi == 1 .and. nshr == 1) then   ! cohesive element in the plane
            at = layer_components(2, [1, 2, 0], [0, 0], 0)
        end if
    end function components

end module friction_layer
